'use strict';

/* The time slider: the whole plan as a strip, and below it a part of it in detail: actions, phases
   and what bears. */

const kActionRow = {top: 0, height: 15};  // px
const kPhaseRow = {top: 16, height: 12};
const kContactRows = {top: 30, height: 4, gap: 1};
const kPhaseOpacity = 0.75;
const kLeastDetail = 4;  // px per phase: below it what bears is drawn for whole segments
const kShortestWindow = 0.5;  // s

/* "12.7 N s" */
function impulseText(phase) {
  const sum = phase.impulses.reduce((total, impulse) => total.add(impulse), new THREE.Vector3());
  return sum.length().toFixed(1) + ' N s';
}

/* "left_sole 2/4, right_sole" */
function bearingText(phase, contacts) {
  const names = phase.contacts.map((contact, i) => {
    const {name, points} = contacts[contact], bearing = phase.bearing[i].length;
    return bearing < points.length ? `${name} ${bearing}/${points.length}` : name;
  });
  return names.join(', ') || 'no contact';
}

class Timeline {
  /* part(id): an element of this timeline. range: {begin, end} of the whole of it. seek(t): called
     when a time is asked for; changed(timeline): when another part is in view. */
  constructor(part, data, motion, range, {seek, changed}) {
    this.part = part;
    this.data = data;
    this.motion = motion;
    this.range = range;
    this.changed = changed;
    this.begin = range.begin;
    this.end = range.end;
    this.time = range.begin;
    this.overview = part('overview');
    this.detail = part('detail');
    this.used = data.contacts.map((contact, i) => i)
        .filter((i) => motion.phases.some((phase) => phase.contacts.includes(i)));
    const rows = this.used.length * (kContactRows.height + kContactRows.gap);
    this.rowsEnd = kContactRows.top + rows;
    part('timeline').style.setProperty('--detail', this.rowsEnd + 15 + 'px');
    part('timeline').classList.toggle('one-segment', motion.segments.length < 2);
    this.connect(this.overview, () => [range.begin, range.end], seek);
    this.connect(this.detail, () => [this.begin, this.end], seek);
    this.detail.addEventListener('wheel', (event) => this.onWheel(event), {passive: false});
    this.detail.addEventListener('dblclick', (event) => {
      if (!motion.segments.length) return;
      this.zoomTo(this.motion.segmentAt(this.timeUnder(event, this.begin, this.end)));
    });
  }

  timeUnder(event, begin, end) {
    const box = event.currentTarget.getBoundingClientRect();
    const fraction = (event.clientX - box.left) / box.width;
    return begin + Math.min(1, Math.max(0, fraction)) * (end - begin);
  }

  connect(canvas, range, seek) {
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(this.timeUnder(event, ...range()));
    });
    canvas.addEventListener('pointermove', (event) => {
      const t = this.timeUnder(event, ...range());
      if (event.buttons) seek(t);
      this.showTip(event, t);
    });
    canvas.addEventListener('pointerleave', () => { element('tip').hidden = true; });
  }

  showTip(event, t) {
    if (!this.motion.phases.length) return;
    const tip = element('tip');
    tip.textContent = this.describe(t);
    tip.hidden = false;
    const half = tip.offsetWidth / 2 + 6;
    const x = Math.min(window.innerWidth - half, Math.max(half, event.clientX));
    tip.style.left = x + 'px';
    const top = this.part('timeline').getBoundingClientRect().top;
    tip.style.bottom = window.innerHeight - top + 6 + 'px';
  }

  describe(t) {
    const phase = this.motion.phaseAt(t);
    const span = `${phase.begin.toFixed(2)}–${phase.end.toFixed(2)} s`;
    const bearing = bearingText(phase, this.data.contacts);
    return `${phase.action} · ${phase.name} · ${span} · ${bearing}`;
  }

  onWheel(event) {
    event.preventDefault();
    const t = this.timeUnder(event, this.begin, this.end);
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
      const shift = event.deltaX / this.detail.clientWidth * (this.end - this.begin);
      this.setWindow(this.begin + shift, this.end + shift);
    } else {
      this.zoomBy(Math.exp(0.0015 * event.deltaY), t);
    }
  }

  /* Makes the part in view `factor` times as long; t stays where it is. */
  zoomBy(factor, t = this.time) {
    const whole = this.range.end - this.range.begin;
    const least = Math.min(1, kShortestWindow / (this.end - this.begin));
    const scale = Math.max(least, Math.min(factor, whole / (this.end - this.begin)));
    this.setWindow(t - scale * (t - this.begin), t + scale * (this.end - t));
  }

  /* A segment or a leg, with a bit of what is around it. */
  zoomTo({begin, end}) {
    const pad = 0.04 * (end - begin);
    this.setWindow(begin - pad, end + pad);
  }
  showAll() { this.setWindow(this.range.begin, this.range.end); }

  setWindow(begin, end) {
    const length = Math.min(end - begin, this.range.end - this.range.begin);
    this.begin = Math.min(Math.max(begin, this.range.begin), this.range.end - length);
    this.end = this.begin + length;
    this.draw();
    this.changed(this);
  }

  /* Has in view what the other one has. */
  take(other) {
    this.begin = other.begin;
    this.end = other.end;
    this.draw();
  }

  get isWhole() {
    return this.end - this.begin > 0.999 * (this.range.end - this.range.begin);
  }

  setTime(t) {
    this.time = t;
    if (t < this.begin || t > this.end) {
      const ahead = t > this.end ? 0.05 : 0.5;
      const begin = t - ahead * (this.end - this.begin);
      this.setWindow(begin, begin + this.end - this.begin);
    }
    this.placeCursors();
  }

  placeCursors() {
    this.detail.setAttribute('aria-valuemin', this.range.begin.toFixed(2));
    this.detail.setAttribute('aria-valuemax', this.range.end.toFixed(2));
    this.detail.setAttribute('aria-valuenow', this.time.toFixed(2));
    this.detail.setAttribute('aria-valuetext', this.motion.phases.length
        ? `${this.time.toFixed(2)} s, ${this.describe(this.time)}` : `${this.time.toFixed(2)} s`);
    const place = (cursor, begin, end) => {
      cursor.style.left = 100 * (this.time - begin) / Math.max(end - begin, 1e-9) + '%';
    };
    place(this.part('overview-cursor'), this.range.begin, this.range.end);
    place(this.part('detail-cursor'), this.begin, this.end);
  }

  draw() {
    if (this.motion.phases.length) {
      this.drawOverview();
      this.drawDetail();
    }
    this.placeCursors();
  }

  drawOverview() {
    const {context, width, height} = openCanvas(this.overview);
    const whole = this.range.end - this.range.begin;
    const x = (t) => (t - this.range.begin) / whole * width;
    for (const leg of this.motion.legs) {
      context.fillStyle = actionColour(leg.action);
      context.fillRect(x(leg.begin), 0, Math.max(1.5, x(leg.end) - x(leg.begin)), height);
    }
    if (this.isWhole) return;
    context.fillStyle = 'rgba(255, 255, 255, 0.62)';
    context.fillRect(0, 0, x(this.begin), height);
    context.fillRect(x(this.end), 0, width, height);
    context.strokeStyle = '#1d2530';
    context.strokeRect(x(this.begin) + 0.5, 0.5, Math.max(2, x(this.end) - x(this.begin) - 1),
                       height - 1);
  }

  drawDetail() {
    const {context, width} = openCanvas(this.detail);
    context.font = kPlotFont;
    context.textBaseline = 'middle';
    const x = (t) => (t - this.begin) / (this.end - this.begin) * width;
    context.fillStyle = '#f1f3f6';
    context.fillRect(0, kContactRows.top, width, this.rowsEnd - kContactRows.top);
    for (const segment of this.motion.segments) {
      if (segment.end < this.begin || segment.begin > this.end) continue;
      const inDetail = segment.flies ||
          (x(segment.end) - x(segment.begin)) / segment.phases.length >= kLeastDetail;
      if (inDetail) this.drawPhases(context, segment, x);
      else this.drawSummary(context, segment, x);
      context.fillStyle = actionColour(segment.action);
      context.fillRect(x(segment.begin), kActionRow.top, x(segment.end) - x(segment.begin),
                       kActionRow.height);
      if (inDetail) this.drawTicks(context, segment, x);
    }
    this.drawNames(context, this.motion.legs, kActionRow, x,
                   (leg) => inkOn(actionColour(leg.action)), (leg) => leg.action);
    this.drawSeams(context, x);
    this.drawImpacts(context, x);
    this.drawTimes(context, width, x);
  }

  drawPhases(context, segment, x) {
    for (const phase of segment.phases) {
      const x0 = x(phase.begin), x1 = x(phase.end);
      context.globalAlpha = kPhaseOpacity;
      context.fillStyle = phaseColour(phase, this.data.contacts);
      context.fillRect(x0, kPhaseRow.top, x1 - x0 + 0.3, kPhaseRow.height);
      context.globalAlpha = 1;
      this.used.forEach((contact, row) => {
        const place = phase.contacts.indexOf(contact);
        if (place < 0) return;
        const all = this.data.contacts[contact].points.length;
        const part = phase.bearing[place].length < all;
        this.drawContact(context, contact, row, x0, x1, part ? 0.5 : 1);
      });
    }
    const ink = (phase) => inkOn(onWhite(phaseColour(phase, this.data.contacts), kPhaseOpacity));
    this.drawNames(context, segment.phases, kPhaseRow, x, ink, (phase) => phase.name);
  }

  /* So many phases that they would blur into each other. */
  drawSummary(context, segment, x) {
    const x0 = x(segment.begin), x1 = x(segment.end);
    context.fillStyle = kPhaseColours.stance;
    context.fillRect(x0, kPhaseRow.top, x1 - x0 + 0.3, kPhaseRow.height);
    context.globalAlpha = 0.55;
    this.used.forEach((contact, row) => {
      if (!segment.phases.some((phase) => phase.contacts.includes(contact))) return;
      this.drawContact(context, contact, row, x0, x1, 1);
    });
    context.globalAlpha = 1;
  }

  /* share: how much of the row's height, for parts of a patch. */
  drawContact(context, contact, row, x0, x1, share) {
    const top = kContactRows.top + row * (kContactRows.height + kContactRows.gap);
    context.fillStyle = limbColour(contact);
    context.fillRect(x0, top + (1 - share) * kContactRows.height, x1 - x0 + 0.3,
                     share * kContactRows.height);
  }

  drawTicks(context, segment, x) {
    context.fillStyle = 'rgba(255, 255, 255, 0.55)';
    for (const phase of segment.phases.slice(1)) {
      context.fillRect(Math.round(x(phase.begin)), kActionRow.top + kActionRow.height - 4, 1, 4);
    }
  }

  drawSeams(context, x) {
    context.fillStyle = '#ffffff';
    for (const segment of this.motion.segments.slice(1)) {
      context.fillRect(Math.round(x(segment.begin)), kActionRow.top, 1,
                       kPhaseRow.top + kPhaseRow.height);
    }
  }

  drawImpacts(context, x) {
    context.fillStyle = kImpulseColour;
    for (const phase of this.motion.phases) {
      if (!phase.impulses.length) continue;
      const at = x(phase.begin);
      context.beginPath();
      context.moveTo(at, kContactRows.top - 1);
      context.lineTo(at - 4, kPhaseRow.top + 4);
      context.lineTo(at + 4, kPhaseRow.top + 4);
      context.fill();
      context.fillRect(at - 0.75, kContactRows.top - 1, 1.5, this.rowsEnd - kContactRows.top);
    }
  }

  /* The names of things in a row, where there is room. */
  drawNames(context, things, row, x, ink, name) {
    context.textAlign = 'center';
    for (const thing of things) {
      const x0 = Math.max(0, x(thing.begin)), x1 = Math.min(this.detail.clientWidth, x(thing.end));
      const text = name(thing);
      if (x1 - x0 < context.measureText(text).width + 6) continue;
      context.fillStyle = ink(thing);
      context.fillText(text, (x0 + x1) / 2, row.top + row.height / 2 + 0.5);
    }
  }

  drawTimes(context, width, x) {
    context.textBaseline = 'top';
    for (const tick of ticks(this.begin, this.end, width / 90)) {
      const at = x(tick.value);
      context.fillStyle = '#98a2b0';
      context.fillRect(Math.round(at), this.rowsEnd, 1, 3);
      context.fillStyle = '#667180';
      context.textAlign = at < 14 ? 'left' : at > width - 14 ? 'right' : 'center';
      context.fillText(tick.text, at, this.rowsEnd + 4);
    }
    context.textBaseline = 'middle';
  }
}
