'use strict';

/* The page: what it says of the plan, its timeline, buttons and keys. */

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50];
const kRoomForBoth = 660, kRoomForOne = 420, kRoomBelow = 460;  // px
const element = (id) => document.getElementById(id);

function addText(parent, tag, text) {
  const child = document.createElement(tag);
  child.textContent = text;
  parent.appendChild(child);
  return child;
}

function addKey(text, colour, kind) {
  const key = addText(element('legend'), 'span', text);
  key.className = 'key ' + kind;
  key.style.setProperty('--colour', colour);
  return key;
}

/* What can be switched. */
const kParts = ['graph', 'route', 'footprints', 'com', 'forces', 'balance', 'barrier'];

class Player {
  constructor(data, motion, drawing) {
    this.data = data;
    this.motion = motion;
    this.drawing = drawing;
    this.time = motion.begin;
    this.playing = false;
    const seek = (t) => this.setTime(t);
    this.timeline = new Timeline(data, motion, seek, () => this.showPlots());
    this.plots = new PlotsPanel(element('plots-grid'), data, motion, seek);
    this.describePlan();
    this.connectButtons();
    this.connectTimeline();
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('hashchange', () => this.applyAddress());
    window.addEventListener('keydown', (event) => this.onKey(event));
    if (data.plots_first) {
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

  describePlan() {
    element('title').textContent = this.data.title;
    for (const [name, value] of this.data.facts) {
      addText(element('facts'), 'dt', name);
      addText(element('facts'), 'dd', value);
    }
    const actions = new Set(
        this.data.segments.map((s) => s.action).concat(this.data.explored.actions));
    for (const action of actions) addKey(action, actionColour(action), 'action');
    if (this.motion.phases.length) {
      this.data.contacts.forEach((contact, i) => addKey(contact.name, limbColour(i), 'limb'));
    }
    if (this.motion.phases.length) addKey('centre of mass', kCentreColour, 'line');
    if (this.motion.flights().length) {
      addKey('its flight', kArcColour, 'line');
      const known = ['preparation', 'crouch', 'toes', 'flight', 'settle', 'landing'];
      const names = new Set(this.motion.phases.map((phase) => phase.name));
      for (const name of known.filter((word) => names.has(word))) {
        addKey(name, kPhaseColours[name], 'phase');
      }
    }
    if (this.motion.phases.some((phase) => phase.impulses.length)) {
      addKey('impact', kImpulseColour, 'line');
    }
    this.balanceKeys = this.motion.phases.length ? this.addBalanceKeys() : [];
    this.describeNo();
    element('graph').parentElement.hidden = !this.data.explored.actions.length;
    element('legs').hidden = this.motion.legs.length < 2;
    for (const speed of kSpeeds) {
      const option = addText(element('speed'), 'option', speed + '×');
      option.value = speed;
      option.selected = speed === 1;
    }
  }

  /* Shown while their switch is on. */
  addBalanceKeys() {
    const keys = [
      addKey('support polygon', kSupportColour, 'action'),
      addKey('zero moment point', kZmpColour, 'limb'),
      addKey('capture point', kCaptureColour, 'ring'),
      addKey('share of the weight', '#667180', 'bar'),
    ];
    keys.forEach((key) => { key.hidden = true; });
    return keys;
  }

  /* Why there is no plan. */
  describeNo() {
    const {no} = this.data;
    const barrier = no && no.barrier;
    element('no').hidden = !no;
    const passage = no && no.passage;
    element('barrier').parentElement.hidden = !barrier && !passage;
    if (!no) return;
    element('no').textContent = no.explanation;
    document.body.classList.add('no-motion');
    for (const part of ['follow', 'route', 'footprints', 'com', 'forces', 'balance']) {
      element(part).parentElement.hidden = true;
    }
    if (passage) addKey('narrowest place', kPassageColour, 'action');
    if (!barrier) return;
    const actions = new Set(barrier.reached.map((region) => region.action));
    for (const action of actions) {
      addKey('reached: ' + (action || 'the pelvis alone'), actionColour(action), 'action');
    }
    addKey('closes the way', kBarrierColour, 'action');
  }

  connectButtons() {
    element('play').addEventListener('click', () => this.setPlaying(!this.playing));
    for (const view of ['iso', 'top', 'side']) {
      element('view-' + view).addEventListener('click', () => this.drawing.look(view));
    }
    const connect = (id, apply) => element(id).addEventListener('change', (event) => {
      apply(event.target.checked);
      this.drawing.update(this.time);
    });
    connect('follow', (on) => { this.drawing.follow = on; });
    for (const part of kParts) {
      connect(part, (on) => { this.drawing[part].visible = on; });
    }
    element('balance').addEventListener('change', (event) => {
      this.balanceKeys.forEach((key) => { key.hidden = !event.target.checked; });
    });
    element('plots-open').addEventListener('click', () => this.openPlots(element('plots').hidden));
    element('plots-close').addEventListener('click', () => this.openPlots(false));
    for (const event of ['pointerenter', 'focus']) {
      element('link').addEventListener(event, () => this.refreshLink());
    }
  }

  connectTimeline() {
    const {timeline} = this;
    const onClick = (id, act) => element(id).addEventListener('click', act);
    onClick('zoom-in', () => timeline.zoomBy(0.5));
    onClick('zoom-out', () => timeline.zoomBy(2));
    onClick('zoom-all', () => timeline.showAll());
    onClick('zoom-segment', () => this.zoomToSegment());
    onClick('previous', () => this.toLeg(-1));
    onClick('next', () => this.toLeg(1));
  }

  zoomToSegment() {
    if (this.motion.segments.length) this.timeline.zoomTo(this.motion.segmentAt(this.time));
  }

  /* To the beginning of the action after this one, or before it. */
  toLeg(step) {
    const {legs} = this.motion;
    if (!legs.length) return;
    const index = legs.indexOf(Motion.lastBegun(legs, this.time)) + step;
    this.setTime(legs[Math.min(legs.length - 1, Math.max(0, index))].begin);
  }

  onKey(event) {
    if (event.target.tagName === 'SELECT') return;
    const views = {1: 'iso', 2: 'top', 3: 'side'};
    const steps = {ArrowLeft: -0.1, ArrowRight: 0.1};
    const acts = {
      ' ': () => this.setPlaying(!this.playing),
      p: () => this.openPlots(element('plots').hidden),
      s: () => this.zoomToSegment(),
      0: () => this.timeline.showAll(),
      '+': () => this.timeline.zoomBy(0.5),
      '-': () => this.timeline.zoomBy(2),
      PageUp: () => this.toLeg(-1),
      PageDown: () => this.toLeg(1),
    };
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key in views) this.drawing.look(views[event.key]);
    else if (event.key in steps) this.setTime(this.time + steps[event.key]);
    else if (event.key in acts) acts[event.key]();
    else return;
    event.preventDefault();
  }

  /* What the address asks for, for example #t=12.5&view=top&play=0&follow=1&graph=0. */
  applyAddress() {
    const asked = new URLSearchParams(location.search);
    new URLSearchParams(location.hash.slice(1)).forEach((value, name) => asked.set(name, value));
    for (const box of ['follow', ...kParts]) {
      if (!asked.has(box)) continue;
      this.switchPart(box, asked.get(box) !== '0');
    }
    if (asked.has('plots')) this.openPlots(asked.get('plots') !== '0');
    const speed = kSpeeds.find((known) => known === Number(asked.get('speed')));
    if (speed) element('speed').value = speed;
    const t = Number(asked.get('t'));
    this.setTime(asked.has('t') && isFinite(t) ? t : this.time);
    const zoom = Number(asked.get('zoom'));
    if (zoom > 0 && isFinite(zoom)) {
      this.timeline.setWindow(this.time - zoom / 2, this.time + zoom / 2);
    } else if (asked.get('zoom') === 'segment') {
      this.zoomToSegment();
    }
    const view = asked.get('view');
    this.drawing.look(['iso', 'top', 'side'].includes(view) ? view : 'iso');
    const camera = (asked.get('camera') || '').split(',').map(Number);
    if (camera.length === 6 && camera.every(isFinite)) this.drawing.lookFrom(camera);
    this.setPlaying(asked.get('play') === '1');
    this.refreshLink();
  }

  /* Lets the link lead to this time and this view. */
  refreshLink() {
    const address = new URLSearchParams(location.hash.slice(1));
    ['play', 'view'].forEach((name) => address.delete(name));
    address.set('t', this.time.toFixed(3));
    address.set('camera', this.drawing.place().map((x) => fixed(x, 3)).join(','));
    element('link').href = '#' + address.toString().replace(/%2C/g, ',');
  }

  switchPart(box, on) {
    element(box).checked = on;
    element(box).dispatchEvent(new Event('change'));
  }

  setPlaying(playing) {
    this.playing = playing && this.motion.phases.length > 0;
    if (this.playing && this.time >= this.motion.end) this.setTime(this.motion.begin);
    element('play').textContent = this.playing ? 'Pause' : 'Play';
  }

  setTime(time) {
    this.time = Math.min(this.motion.end, Math.max(this.motion.begin, time));
    this.drawing.update(this.time);
    element('clock').textContent = `${this.time.toFixed(2)} / ${this.motion.end.toFixed(2)} s`;
    if (!this.motion.phases.length) return;
    this.timeline.setTime(this.time);
    const phase = this.motion.phaseAt(this.time);
    element('action').textContent = phase.action;
    element('action').style.setProperty('--colour', actionColour(phase.action));
    element('phase').textContent = phase.name;
    element('phase').style.setProperty('--colour', phaseColour(phase, this.data.contacts));
    const hit = phase.impulses.length > 0 && this.time - phase.begin <= kImpactShown;
    element('contacts').textContent = element('contacts').title =
        hit ? 'impact of ' + impulseText(phase) : bearingText(phase, this.data.contacts);
    element('contacts').classList.toggle('impact', hit);
    if (element('plots').hidden) return;
    if (this.plots.segment !== this.motion.segmentAt(this.time)) this.showPlots();
    this.plots.setTime(this.time);
  }

  openPlots(open) {
    element('plots').hidden = !open || !this.motion.segments.length;
    document.body.classList.toggle('with-plots', !element('plots').hidden);
    this.resize();
    this.foldWhatHasNoRoom();
  }

  /* Plots what of the segment the timeline shows. */
  showPlots() {
    if (element('plots').hidden) return;
    const segment = this.motion.segmentAt(this.time);
    this.plots.show(segment, this.timeline.begin, this.timeline.end);
    this.plots.setTime(this.time);
    const {begin, end} = this.plots, index = this.motion.segments.indexOf(segment) + 1;
    const place = this.motion.segments.length > 1
        ? `, segment ${index} of ${this.motion.segments.length}` : '';
    element('plots-title').textContent =
        `${segment.action}${place}: ${begin.toFixed(2)} to ${end.toFixed(2)} s`;
  }

  advance(seconds) {
    if (this.playing) {
      this.setTime(this.time + seconds * Number(element('speed').value));
      if (this.time >= this.motion.end) this.setPlaying(false);
    }
    this.drawing.render();
  }

  resize() {
    const stage = element('stage');
    this.drawing.resize(stage.clientWidth, stage.clientHeight);
    this.timeline.draw();
    this.showPlots();
  }

  foldWhatHasNoRoom() {
    const {clientWidth, clientHeight} = element('stage');
    if (clientWidth < kRoomForBoth || clientHeight < kRoomBelow) element('options').open = false;
    if (clientWidth < kRoomForOne) element('summary').open = false;
  }
}

function showMessage(text) {
  element('message').textContent = text;
  element('message').hidden = false;
}

function openPage() {
  const data = JSON.parse(element('plan-data').textContent);
  actionColours = data.action_colors;
  const motion = new Motion(data);
  let drawing;
  try {
    drawing = new Drawing(element('canvas'), data, motion);
  } catch (error) {
    showMessage('This page draws with WebGL, which this browser does not offer or has switched ' +
                'off (' + error.message + '). Open it in a browser with WebGL.');
    return;
  }
  new Player(data, motion, drawing);
}

openPage();
