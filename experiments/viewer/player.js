'use strict';

/* The page: what it says of the plan, its timeline, buttons and keys. */

const kSpeeds = [0.5, 1, 2, 5, 10, 20, 50];
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
}

class Player {
  constructor(data, motion, drawing) {
    this.data = data;
    this.motion = motion;
    this.drawing = drawing;
    this.time = motion.begin;
    this.playing = false;
    this.describePlan();
    this.fillTimeline();
    this.connectButtons();
    this.connectTimeline();
    window.addEventListener('resize', () => this.resize());
    window.addEventListener('hashchange', () => this.applyAddress());
    window.addEventListener('keydown', (event) => this.onKey(event));
    this.resize();
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
    this.data.contacts.forEach((contact, i) => addKey(contact.name, limbColour(i), 'limb'));
    for (const speed of kSpeeds) {
      const option = addText(element('speed'), 'option', speed + '×');
      option.value = speed;
      option.selected = speed === 1;
    }
  }

  fillTimeline() {
    const length = this.motion.end - this.motion.begin;
    this.data.segments.forEach((segment, index) => {
      const phases = this.motion.phases.filter((phase) => phase.segment === index);
      if (!phases.length) return;
      const begin = phases[0].begin, end = phases[phases.length - 1].end;
      const bar = addText(element('bars'), 'div', '');
      bar.style.left = 100 * (begin - this.motion.begin) / length + '%';
      bar.style.width = 100 * (end - begin) / length + '%';
      bar.style.background = actionColour(segment.action);
      bar.title = segment.action;
    });
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
    for (const part of ['graph', 'footprints', 'forces']) {
      connect(part, (on) => { this.drawing[part].visible = on; });
    }
  }

  connectTimeline() {
    const timeline = element('timeline');
    const seek = (event) => {
      const box = timeline.getBoundingClientRect();
      const fraction = (event.clientX - box.left) / box.width;
      this.setTime(this.motion.begin + fraction * (this.motion.end - this.motion.begin));
    };
    timeline.addEventListener('pointerdown', (event) => {
      timeline.setPointerCapture(event.pointerId);
      seek(event);
    });
    timeline.addEventListener('pointermove', (event) => {
      if (event.buttons) seek(event);
    });
  }

  onKey(event) {
    if (event.target.tagName === 'SELECT') return;
    const views = {1: 'iso', 2: 'top', 3: 'side'};
    const steps = {ArrowLeft: -0.1, ArrowRight: 0.1};
    if (event.key === ' ') this.setPlaying(!this.playing);
    else if (event.key in views) this.drawing.look(views[event.key]);
    else if (event.key in steps) this.setTime(this.time + steps[event.key]);
    else return;
    event.preventDefault();
  }

  /* What the address asks for, for example #t=12.5&view=top&play=0&follow=1&graph=0. */
  applyAddress() {
    const asked = new URLSearchParams(location.search);
    new URLSearchParams(location.hash.slice(1)).forEach((value, name) => asked.set(name, value));
    for (const box of ['follow', 'graph', 'footprints', 'forces']) {
      if (!asked.has(box)) continue;
      element(box).checked = asked.get(box) !== '0';
      element(box).dispatchEvent(new Event('change'));
    }
    const speed = kSpeeds.find((known) => known === Number(asked.get('speed')));
    if (speed) element('speed').value = speed;
    const t = Number(asked.get('t'));
    this.setTime(asked.has('t') && isFinite(t) ? t : this.time);
    const view = asked.get('view');
    this.drawing.look(['iso', 'top', 'side'].includes(view) ? view : 'iso');
    this.setPlaying(asked.get('play') === '1');
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
    const phase = this.motion.phaseAt(this.time);
    element('action').textContent = phase.action;
    element('action').style.setProperty('--colour', actionColour(phase.action));
    const names = phase.contacts.map((contact) => this.data.contacts[contact].name);
    element('contacts').textContent = names.length ? names.join(', ') : 'no contact';
    const length = this.motion.end - this.motion.begin;
    element('cursor').style.left = 100 * (this.time - this.motion.begin) / length + '%';
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
  }
}

function showMessage(text) {
  element('message').textContent = text;
  element('message').hidden = false;
}

function openPage() {
  const data = JSON.parse(element('plan-data').textContent);
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
