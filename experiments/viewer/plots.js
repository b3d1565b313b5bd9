'use strict';

/* The panel of plots: what the joints, the ground and the robot as a whole do in one segment. */

const kCurveColours = ['#2667c9', '#d1495b', '#1b998b', '#e6a117', '#6a4c93'];
const kFaint = 'rgba(110, 122, 138, 0.45)';
const kLeastNormal = 1;  // N: friction of what bears less means nothing
const kMostGroups = 4;   // joints, or pairs of them, that are named

/* Name, title, unit and source of every plot. */
const kPlots = [
  ['positions', 'Joint positions', '% of range', 'q of the plan in the ranges of the robot'],
  ['speeds', 'Joint speeds', '% of limit (rad/s)', 'v of the plan over the limits of the robot'],
  ['torques', 'Joint torques', '% of limit (N m)', 'tau of the plan over the limits of the robot'],
  ['forces', 'Normal forces', '% of weight (N)', 'Forces of the plan, vertical, summed by patch'],
  ['friction', 'Friction used', '% of cone',
   'Forces of the plan: horizontal over vertical part and the friction of the robot, worst point'],
  ['shares', 'Margins, used shares', '% of limit',
   'Measured as the verifier does, worst joint or point, worst knot of the plan since the last drawn'],
  ['distances', 'Margins, distances', 'm',
   'Measured as the verifier does, worst pair or point, worst knot of the plan since the last drawn'],
  ['height', 'Centre of mass, height', 'm', 'From q of the plan and the masses of the links'],
  ['forward', 'Centre of mass, forward', 'm', 'From q of the plan and the masses of the links'],
  ['balanceX', 'Balance, world x', 'm', 'From the forces of the plan, where they act, and q and v'],
  ['balanceY', 'Balance, world y', 'm', 'From the forces of the plan, where they act, and q and v'],
  ['margin', 'Z.m.p. from edge of support', 'm, inside positive',
   'From the forces of the plan and where they act, at the knots that are drawn'],
  ['linear', 'Linear momentum', 'N s', 'From q and v of the plan and the masses of the links'],
  ['angular', 'Angular momentum about c.o.m.', 'N m s',
   'From q and v of the plan and the masses and inertias of the links'],
];

/* "L/RKP" for LKP and RKP. */
function pairName(a, b) {
  let i = 0;
  while (i < a.length && a[i] === b[i]) ++i;
  let j = 0;
  while (j < a.length - i && j < b.length - i && a[a.length - 1 - j] === b[b.length - 1 - j]) ++j;
  const differ = [a.slice(i, a.length - j), b.slice(i, b.length - j)];
  return i + j > 0 && differ[0] && differ[1]
      ? a.slice(0, i) + differ.join('/') + a.slice(a.length - j) : a + ', ' + b;
}

class PlotsPanel {
  constructor(parent, data, motion, seek) {
    this.data = data;
    this.motion = motion;
    this.parent = parent;
    this.plots = {};
    for (const [name, title, unit, source] of kPlots) {
      const plot = new CurvePlot(parent, title, unit, source, seek);
      plot.time = (knot) => motion.knots[knot * motion.stride];
      this.plots[name] = plot;
    }
    this.key = addText(parent, 'div', '');
    this.key.className = 'phase-key';
    this.groups = this.jointGroups();
  }

  setVisible(visible) {
    for (const plot of Object.values(this.plots)) plot.figure.hidden = !visible;
    this.key.hidden = !visible;
  }

  /* Joints, left and right ones together. */
  jointGroups() {
    const names = this.data.joints.map((joint) => joint.name);
    const paired = new Set([].concat(...this.data.pairs));
    const pairs = this.data.pairs.map(
        ([left, right]) => ({name: pairName(names[left], names[right]), joints: [left, right]}));
    const singles = names.map((name, i) => ({name, joints: [i]}));
    return pairs.concat(singles.filter((group) => !paired.has(group.joints[0])));
  }

  /* Plots what of a segment lies within [begin, end]. */
  show(segment, begin, end) {
    this.begin = Math.max(begin, segment.begin);
    this.end = Math.min(end, segment.end);
    if (!(this.end > this.begin)) [this.begin, this.end] = [segment.begin, segment.end];
    this.segment = segment;
    this.phases =
        segment.phases.filter((phase) => phase.end > this.begin && phase.begin < this.end);
    this.frame = this.headingFrame(segment);
    this.showJoints();
    this.showContacts();
    this.showMargins();
    this.showWhole();
    this.showBalance();
    this.showPhaseKey();
  }

  put(name, content) {
    const bandColour = (phase) => phaseColour(phase, this.data.contacts);
    const nothing = {limits: [], marks: [], include: [], range: null, most: Infinity};
    this.plots[name].show(
        {...nothing, ...content, phases: this.phases, bandColour}, this.begin, this.end);
  }

  /* Unit vectors forward and to the left, as the robot is headed when the segment begins. */
  headingFrame(segment) {
    const at = segment.phases[0].first * this.motion.stride + 1, q = this.motion.knots;
    const x = new THREE.Vector3(1, 0, 0).applyQuaternion(
        new THREE.Quaternion(q[at + 1], q[at + 2], q[at + 3], q[at])).setZ(0).normalize();
    return {forward: x, left: new THREE.Vector3(-x.y, x.x, 0)};
  }

  showJoints() {
    const {joints} = this.data, {knots, stride, rates, torques} = this.motion;
    const degrees = (joint, value) => joint.prismatic
        ? fixed(value, 3) + ' m' : fixed(value * 180 / Math.PI, 0) + '°';
    this.showShares('positions', (joint, i) => joint.range && {
      share: (knot) => {
        const [low, high] = joint.range;
        return 100 * (2 * knots[knot * stride + 8 + i] - low - high) / (high - low);
      },
      text: (share) => degrees(
          joint, (joint.range[0] + joint.range[1] + share / 100 *
                  (joint.range[1] - joint.range[0])) / 2),
    });
    this.showShares('speeds', (joint, i) => joint.speed && {
      share: (knot) => 100 * rates.at(knot, i) / joint.speed,
      text: (share) =>
          fixed(share / 100 * joint.speed, 1) + (joint.prismatic ? ' m/s' : ''),
    });
    this.showShares('torques', (joint, i) => joint.effort && {
      share: (knot) => 100 * torques.at(knot, i) / joint.effort,
      text: (share) => fixed(share / 100 * joint.effort, 0) + (joint.prismatic ? ' N' : ''),
    });
  }

  /* A share of a limit by joint: those that come closest to it by name, the others faint. */
  showShares(name, describe) {
    const shares = this.data.joints.map(describe);
    const peaks = shares.map((share) => share ? this.peak(share.share) : -1);
    const peak = (group) => Math.max(...group.joints.map((joint) => peaks[joint]));
    const ranked = this.groups.filter((group) => peak(group) > 0.5)
                       .sort((a, b) => peak(b) - peak(a));
    const curves = [];
    ranked.forEach((group, rank) => group.joints.forEach((joint, side) => {
      if (!shares[joint]) return;
      const named = rank < kMostGroups;
      curves.push({
        label: named && side === 0 ? group.name : '',
        colour: named ? kCurveColours[rank] : kFaint,
        dashed: named && side > 0,
        faint: !named,
        value: (phase, knot) => shares[joint].share(knot),
        text: shares[joint].text,
      });
    }));
    const highest = Math.max(0, ...peaks);
    const shown = [20, 50, 108].find((edge) => edge >= 1.05 * highest) || 1.1 * highest;
    this.put(name, {
      curves: curves,
      range: [-shown, shown],
      limits: [{y: 100, text: ''}, {y: -100, text: ''}],
    });
  }

  peak(share) {
    let highest = 0;
    for (const phase of this.phases) {
      for (let knot = phase.first; knot < phase.first + phase.count; ++knot) {
        highest = Math.max(highest, Math.abs(share(knot)));
      }
    }
    return highest;
  }

  /* Offsets of a contact's forces at a knot; none if it does not bear. */
  forceOffsets(phase, knot, contact) {
    const place = phase.contacts.indexOf(contact);
    if (place < 0) return null;
    const before = phase.bearing.slice(0, place).reduce((sum, points) => sum + points.length, 0);
    const first = phase.forces + 3 * (phase.points * (knot - phase.first) + before);
    return phase.bearing[place].map((_, i) => first + 3 * i);
  }

  showContacts() {
    const {forces} = this.motion, {weight} = this.data;
    const bearing = this.data.contacts.map((contact, i) => i)
        .filter((i) => this.phases.some((phase) => phase.contacts.includes(i)));
    const curves = (ofPoints, text) => bearing.map((contact) => ({
      label: this.data.contacts[contact].name,
      colour: limbColour(contact),
      dashed: contact % 2 > 0,  // left and right often coincide
      value: (phase, knot) => {
        const offsets = this.forceOffsets(phase, knot, contact);
        return offsets && ofPoints(offsets);
      },
      text,
    }));
    const marks = this.phases.filter((phase) => phase.impulses.length).map((phase) => ({
      t: phase.begin, text: impulseText(phase), colour: kImpulseColour}));
    this.put('forces', {
      curves: curves((at) => at.reduce((sum, o) => sum + forces[o + 2], 0) * 100 / weight,
                     (share) => fixed(share / 100 * weight, 0)),
      limits: [{y: 100, text: 'weight', colour: '#667180'}],
      marks,
      include: [0],
    });
    const share = (o) => forces[o + 2] < kLeastNormal ? 0
        : 100 * Math.hypot(forces[o], forces[o + 1]) / (this.data.friction * forces[o + 2]);
    this.put('friction', {
      curves: curves((at) => Math.max(...at.map(share)), (n) => fixed(n, 0)),
      limits: [{y: 100, text: ''}],
      range: [0, 108],
    });
  }

  showMargins() {
    const {margins} = this.motion;
    const contents = marginContents((column, scale) => (phase, knot) => {
      const value = margins.at(knot, column);
      return isNaN(value) ? null : scale * value;
    });
    for (const [name, content] of Object.entries(contents)) this.put(name, content);
  }

  showWhole() {
    const {centres, momenta} = this.motion, {forward, left} = this.frame;
    const start = this.motion.centreOfKnot(this.segment.phases[0].first);
    const centre = (axis, from) => (phase, knot) =>
        (centres[3 * knot] - from.x) * axis.x + (centres[3 * knot + 1] - from.y) * axis.y +
        (centres[3 * knot + 2] - from.z) * axis.z;
    const up = new THREE.Vector3(0, 0, 1), none = new THREE.Vector3();
    const one = (label, colour, value, digits) =>
        ({label, colour, value, text: (n) => fixed(n, digits)});
    this.put('height', {curves: [one('height', '#1d2530', centre(up, none), 3)]});
    this.put('forward', {curves: [one('forward', '#1d2530', centre(forward, start), 3)]});
    const momentum = (first, axis) => (phase, knot) => momenta.at(knot, first) * axis.x +
        momenta.at(knot, first + 1) * axis.y + momenta.at(knot, first + 2) * axis.z;
    const three = (first, names) => [forward, left, up].map(
        (axis, i) => one(names[i], kCurveColours[i], momentum(first, axis), 1));
    this.put('linear', {curves: three(0, ['forward', 'left', 'up'])});
    this.put('angular', {curves: three(3, ['roll', 'pitch', 'yaw'])});
  }

  /* Centre of mass, zero moment point and capture point in the world, and the reserve. */
  showBalance() {
    const {centres} = this.motion;
    const curve = (label, colour, value) =>
        ({label, colour, value: (phase, knot) => value(knot), text: (n) => fixed(n, 3)});
    const balance = (column) => (knot) => this.motion.balanceOfKnot(knot, column);
    const inWorld = (axis) => ({curves: [
      curve('z.m.p.', kZmpColour, balance(axis)),
      curve('capture point', kCaptureColour, balance(4 + axis)),
      curve('c.o.m.', kCentreColour, (knot) => centres[3 * knot + axis]),
    ]});
    this.put('balanceX', inWorld(0));
    this.put('balanceY', inWorld(1));
    this.put('margin', {
      curves: [curve('distance', kZmpColour, balance(3))],
      limits: [{y: 0, text: ''}],
    });
  }

  /* What the bands behind the plots mean. */
  showPhaseKey() {
    this.key.textContent = '';
    const seen = new Set();
    for (const phase of this.phases) {
      if (seen.has(phase.name)) continue;
      seen.add(phase.name);
      const key = addText(this.key, 'span', phase.name);
      key.className = 'band';
      key.style.setProperty('--colour', phaseColour(phase, this.data.contacts));
    }
  }

  setTime(t) {
    const phase = this.motion.phaseAt(t), place = this.motion.locate(phase, t);
    for (const plot of Object.values(this.plots)) plot.setTime(t, phase, place);
  }

  redraw() {
    for (const plot of Object.values(this.plots)) plot.draw();
  }
}
