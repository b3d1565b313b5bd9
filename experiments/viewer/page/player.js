'use strict';

/* The page: its time, buttons, keys and address, for all of its plans. */

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50];
const kRoomForBoth = 660, kRoomForOne = 420, kRoomBelow = 460;  // px

/* What can be switched. */
const kParts = ['graph', 'route', 'footprints', 'com', 'forces', 'balance', 'collision', 'barrier'];

/* Whether the reader's system asks for pages that do not move by themselves. */
const prefersStillness = () => window.matchMedia('(prefers-reduced-motion: reduce)').matches;

class Player {
  /* views: makes the plans' views from the page's range of time and the callbacks of timelines. */
  constructor(range, makeViews) {
    this.begin = range.begin;
    this.end = range.end;
    this.time = this.begin;
    this.playing = false;
    const seek = (t) => this.setTime(t);
    this.views = makeViews({seek, changed: (timeline) => this.showWindow(timeline)});
    this.plots = this.views.map(
        ({data, motion}) => new PlotsPanel(element('plots-grid'), data, motion, seek));
    this.choosePlots(Math.max(0, this.views.findIndex((view) => view.moves)));
    this.describePlans();
    this.connectButtons();
    this.connectTimeline();
    this.connectCameras();
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('hashchange', () => this.applyAddress());
    connectKeys(this);
    if (this.views[0].data.plots_first) {
      this.openPlots(true);
      this.switchPart('route', false);
    }
    this.resize();
    this.foldWhatHasNoRoom();
    this.applyAddress();
    let last = performance.now();
    const frame = (now) => {
      this.advance((now - last) / 1000);
      last = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  get moves() { return this.views.some((view) => view.moves); }
  /* The one whose segments and plots are meant. */
  get chosen() { return this.views[this.choice]; }

  describePlans() {
    this.balanceKeys = addLegend(this.views).balanceKeys;
    const some = (has) => this.views.some(has);
    element('graph').parentElement.hidden = !some(({data}) => data.explored.actions.length);
    element('barrier').parentElement.hidden =
        !some(({data}) => data.no && (data.no.barrier || data.no.passage));
    element('collision').parentElement.hidden =
        !some(({data}) => data.links.some((link) => link.look));
    element('legs').hidden = !some(({motion}) => motion.legs.length > 1);
    element('linked').parentElement.hidden = this.views.length < 2;
    element('plots-of').hidden = this.views.filter((view) => view.moves).length < 2;
    document.body.classList.toggle('no-motion', !this.moves);
    document.body.classList.toggle(
        'short-player', this.views.length < 2 && this.views[0].motion.segments.length < 2);
    for (const part of ['follow', 'route', 'footprints', 'com', 'forces', 'balance']) {
      element(part).parentElement.hidden = !this.moves;
    }
    for (const speed of kSpeeds) {
      const option = addText(element('speed'), 'option', speed + '×');
      option.value = speed;
      option.selected = speed === 1;
    }
  }

  connectButtons() {
    element('play').addEventListener('click', () => this.setPlaying(!this.playing));
    for (const view of ['iso', 'top', 'side']) {
      element('view-' + view).addEventListener('click', () => this.look(view));
    }
    const connect = (id, apply) => element(id).addEventListener('change', (event) => {
      this.views.forEach(({drawing}) => apply(drawing, event.target.checked));
      this.setTime(this.time);
    });
    connect('follow', (drawing, on) => { drawing.follow = on; });
    for (const part of kParts) {
      connect(part, (drawing, on) => { drawing[part].visible = on; });
    }
    element('balance').addEventListener('change', (event) => {
      this.balanceKeys.forEach((key) => { key.hidden = !event.target.checked; });
    });
    element('plots-open').addEventListener('click', () => this.openPlots(element('plots').hidden));
    element('plots-close').addEventListener('click', () => this.openPlots(false));
    element('plots-of').addEventListener('change', (event) => {
      this.choosePlots(Number(event.target.value));
      this.showPlots();
    });
    for (const event of ['pointerenter', 'focus']) {
      element('link').addEventListener(event, () => this.refreshLink());
    }
  }

  connectTimeline() {
    const {timeline} = this.views[0];
    const onClick = (id, act) => element(id).addEventListener('click', act);
    onClick('zoom-in', () => timeline.zoomBy(0.5));
    onClick('zoom-out', () => timeline.zoomBy(2));
    onClick('zoom-all', () => timeline.showAll());
    onClick('zoom-segment', () => this.zoomToSegment());
    onClick('previous', () => this.toLeg(-1));
    onClick('next', () => this.toLeg(1));
  }

  /* What one timeline has in view, the others have, too. */
  showWindow(timeline) {
    for (const view of this.views || []) {
      if (view.timeline !== timeline) view.timeline.take(timeline);
    }
    this.showPlots();
  }

  /* While they are linked, all look at their world from the same place. */
  connectCameras() {
    let busy = false;
    for (const {drawing} of this.views) {
      drawing.controls.addEventListener('change', () => {
        if (busy || !element('linked').checked) return;
        busy = true;
        for (const other of this.views) {
          if (other.drawing !== drawing) other.drawing.lookLike(drawing);
        }
        busy = false;
      });
    }
  }

  /* The one with the largest world comes last: while cameras are linked, its view counts. */
  look(view) {
    const drawings = this.views.map(({drawing}) => drawing);
    drawings.sort((a, b) => a.size - b.size).forEach((drawing) => drawing.look(view));
  }

  zoomToSegment() {
    const {motion, timeline} = this.chosen;
    if (motion.segments.length) timeline.zoomTo(this.chosen.segment());
  }

  /* To the beginning of the action after this one, or before it. */
  toLeg(step) {
    const {legs} = this.chosen.motion;
    if (!legs.length) return;
    const index = legs.indexOf(Motion.lastBegun(legs, this.time)) + step;
    this.setTime(legs[Math.min(legs.length - 1, Math.max(0, index))].begin);
  }

  /* Turns the views about the vertical and over it, rad. */
  turn(about, over) { this.movedViews().forEach(({drawing}) => drawing.turn(about, over)); }
  approach(factor) { this.movedViews().forEach(({drawing}) => drawing.approach(factor)); }
  /* Those whose cameras do not follow that of another. */
  movedViews() { return element('linked').checked ? this.views.slice(0, 1) : this.views; }

  /* Says to screen readers where the plans are. */
  announce() {
    const texts = this.views.filter((view) => view.moves).map((view) => view.text());
    element('announcer').textContent = `${this.time.toFixed(1)} s. ` + texts.join('. ');
  }

  /* What the address asks for, for example #t=12.5&view=top&play=0&follow=1&graph=0. */
  applyAddress() {
    const asked = new URLSearchParams(location.search);
    new URLSearchParams(location.hash.slice(1)).forEach((value, name) => asked.set(name, value));
    for (const box of ['follow', 'linked', ...kParts]) {
      if (!asked.has(box)) continue;
      this.switchPart(box, asked.get(box) !== '0');
    }
    if (asked.has('bare')) this.showBare(asked.get('bare') !== '0');
    if (asked.has('plots')) this.openPlots(asked.get('plots') !== '0');
    const speed = kSpeeds.find((known) => known === Number(asked.get('speed')));
    if (speed) element('speed').value = speed;
    const t = Number(asked.get('t'));
    this.setTime(asked.has('t') && isFinite(t) ? t : this.time);
    const zoom = Number(asked.get('zoom'));
    if (zoom > 0 && isFinite(zoom)) {
      this.views[0].timeline.setWindow(this.time - zoom / 2, this.time + zoom / 2);
    } else if (asked.get('zoom') === 'segment') {
      this.zoomToSegment();
    }
    const view = asked.get('view');
    this.look(['iso', 'top', 'side'].includes(view) ? view : 'iso');
    const camera = (asked.get('camera') || '').split(',').map(Number);
    if (camera.length === 6 && camera.every(isFinite)) this.views[0].drawing.lookFrom(camera);
    this.setPlaying(asked.get('play') === '1' && !prefersStillness());
    this.refreshLink();
  }

  /* The drawing alone. */
  showBare(bare) {
    document.body.classList.toggle('bare', bare);
    this.resize();
  }

  /* Lets the link lead to this time and this view. */
  refreshLink() {
    const address = new URLSearchParams(location.hash.slice(1));
    ['play', 'view'].forEach((name) => address.delete(name));
    address.set('t', this.time.toFixed(3));
    address.set('camera', this.views[0].drawing.place().map((x) => fixed(x, 3)).join(','));
    element('link').href = '#' + address.toString().replace(/%2C/g, ',');
  }

  switchPart(box, on) {
    element(box).checked = on;
    element(box).dispatchEvent(new Event('change'));
  }

  setPlaying(playing) {
    this.playing = playing && this.moves;
    if (this.playing && this.time >= this.end) this.setTime(this.begin);
    element('play').textContent = this.playing ? 'Pause' : 'Play';
    if (!this.playing) this.announce();
  }

  setTime(time) {
    this.time = Math.min(this.end, Math.max(this.begin, time));
    this.views.forEach((view) => view.setTime(this.time));
    element('clock').textContent = `${this.time.toFixed(2)} / ${this.end.toFixed(2)} s`;
    if (!this.moves || element('plots').hidden) return;
    const plots = this.plots[this.choice];
    if (plots.segment !== this.chosen.segment()) this.showPlots();
    plots.setTime(this.chosen.time);
  }

  /* Whose plots the panel has. */
  choosePlots(choice) {
    this.choice = choice;
    this.plots.forEach((plots, i) => plots.setVisible(i === choice));
  }

  openPlots(open) {
    element('plots').hidden = !open || !this.chosen.moves;
    document.body.classList.toggle('with-plots', !element('plots').hidden);
    element('plots-open').setAttribute('aria-expanded', String(!element('plots').hidden));
    this.resize();
    this.foldWhatHasNoRoom();
  }

  /* Plots what of the segment the timeline shows. */
  showPlots() {
    if (element('plots').hidden || !this.chosen.moves) return;
    const {motion, timeline, time} = this.chosen, plots = this.plots[this.choice];
    const segment = this.chosen.segment();
    plots.show(segment, timeline.begin, timeline.end);
    plots.setTime(time);
    const index = motion.segments.indexOf(segment) + 1;
    const place = motion.segments.length > 1
        ? `, segment ${index} of ${motion.segments.length}` : '';
    element('plots-title').textContent =
        `${segment.action}${place}: ${plots.begin.toFixed(2)} to ${plots.end.toFixed(2)} s`;
  }

  advance(seconds) {
    if (this.playing) {
      this.setTime(this.time + seconds * Number(element('speed').value));
      if (this.time >= this.end) this.setPlaying(false);
    }
    this.views.forEach(({drawing}) => drawing.render());
  }

  resize() {
    this.views.forEach((view) => view.resize());
    this.showPlots();
  }

  foldWhatHasNoRoom() {
    const {clientWidth, clientHeight} = this.views[0].part('canvas');
    if (clientWidth < kRoomForBoth || clientHeight < kRoomBelow) element('options').open = false;
    if (clientWidth < kRoomForOne) {
      this.views.forEach((view) => { view.part('summary').open = false; });
    }
  }
}

function showMessage(text) {
  element('message').textContent = text;
  element('message').hidden = false;
}

/* Of each plan: its name on the page, its data and motion. */
function readPlans() {
  return ['', 'b'].filter((name) => element(name ? 'plan-data-' + name : 'plan-data'))
      .map((name) => {
        const data = JSON.parse(element(name ? 'plan-data-' + name : 'plan-data').textContent);
        Object.assign(actionColours, data.action_colors);
        return {name, data, motion: new Motion(data)};
      });
}

/* Returns the page's player, or null without WebGL. */
function openPage() {
  const plans = readPlans();
  const range = {begin: Math.min(...plans.map(({motion}) => motion.begin)),
                 end: Math.max(...plans.map(({motion}) => motion.end))};
  plans.filter(({name}) => name).forEach(({name}) => makeRoomFor(name));
  try {
    return new Player(range, (callbacks) => plans.map(
        ({data, motion, name}) => new PlanView(data, motion, name, range, callbacks)));
  } catch (error) {
    if (!(error instanceof NoWebGl)) throw error;
    showMessage('This page draws with WebGL, which this browser does not offer or has switched ' +
                'off (' + error.message + '). Open it in a browser with WebGL.');
    return null;
  }
}

const page = openPage();
