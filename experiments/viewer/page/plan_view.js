'use strict';

/* One plan on the page: its facts, its drawing, its part of the timeline, and what it does at the
   present time. A page has one or two. */

const element = (id) => document.getElementById(id);

function addText(parent, tag, text) {
  const child = document.createElement(tag);
  child.textContent = text;
  parent.appendChild(child);
  return child;
}

/* A copy of an element of the first plan, for the one called `name`: ids get its name. */
function copyFor(name, id) {
  const copy = element(id).cloneNode(true);
  for (const part of [copy, ...copy.querySelectorAll('[id]')]) part.id += '-' + name;
  return copy;
}

/* Room on the page for a second plan. */
function makeRoomFor(name) {
  document.body.classList.add('two-plans');
  element('stage').appendChild(copyFor(name, 'canvas'));
  element('summary').after(copyFor(name, 'summary'));
  const row = addText(element('player'), 'div', '');
  row.className = 'second';
  row.append(copyFor(name, 'what'), copyFor(name, 'timeline'));
}

class PlanView {
  /* name: '' of the first plan. range: {begin, end} of the page's time. */
  constructor(data, motion, name, range, callbacks) {
    Object.assign(this, {data, motion, name});
    this.drawing = new Drawing(this.part('canvas'), data, motion);
    this.timeline = new Timeline((id) => this.part(id), data, motion, range, callbacks);
    this.describe();
    this.part('canvas').setAttribute('aria-label', 'Drawing of ' + data.title);
  }

  part(id) { return element(this.name ? id + '-' + this.name : id); }

  describe() {
    const {no} = this.data;
    this.part('title').textContent = this.data.title;
    for (const [name, value] of this.data.facts) {
      addText(this.part('facts'), 'dt', name);
      addText(this.part('facts'), 'dd', value);
    }
    this.part('no').hidden = !no;
    if (no) this.part('no').textContent = no.explanation;
    this.part('timeline').hidden = !this.moves;
    if (!this.moves) this.part('contacts').textContent = 'no motion';
  }

  get moves() { return this.motion.phases.length > 0; }

  /* Moves the robot to time t, or to where it is at its end. */
  setTime(t) {
    const {motion} = this, own = Math.min(motion.end, Math.max(motion.begin, t));
    this.time = own;
    this.drawing.update(own);
    if (!this.moves) return;
    this.timeline.setTime(t);
    const phase = motion.phaseAt(own);
    const show = (id, text, colour) => {
      this.part(id).textContent = text;
      this.part(id).style.setProperty('--colour', colour);
    };
    show('action', phase.action, actionColour(phase.action));
    show('phase', phase.name, phaseColour(phase, this.data.contacts));
    const hit = phase.impulses.length > 0 && own - phase.begin <= kImpactShown;
    const what = t > own + 1e-9 ? `ended at ${motion.end.toFixed(2)} s`
        : hit ? 'impact of ' + impulseText(phase) : bearingText(phase, this.data.contacts);
    this.part('contacts').textContent = this.part('contacts').title = what;
    this.part('contacts').classList.toggle('impact', hit);
  }

  /* What it does now, in words. */
  text() {
    const {name} = this.data.segments.length ? this.motion.phaseAt(this.time) : {name: ''};
    return [this.part('action').textContent, name, this.part('contacts').title].join(', ');
  }

  segment() { return this.motion.segmentAt(this.time); }

  resize() {
    const canvas = this.part('canvas');
    this.drawing.resize(canvas.clientWidth, canvas.clientHeight);
    this.timeline.draw();
  }
}
