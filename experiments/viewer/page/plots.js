'use strict';

/* The panel of plots: what the joints, the ground and the robot as a whole do in one segment. */

const kCurveColours = ['#2667c9', '#d1495b', '#1b998b', '#e6a117', '#6a4c93'];
const kFaint = 'rgba(110, 122, 138, 0.45)';
const kLeastNormal = 1;  // N: friction of what bears less means nothing
const kMostGroups = 4;   // joints, or pairs of them, that are named
const kMostShare = 1000; // per cent that a plot shows of a motor that can do nothing

/* Name, title, unit and source of every plot. */
const kPlots = [
  ['positions', 'Joint positions', '% of range', 'q of the plan in the ranges of the robot'],
  ['speeds', 'Joint speeds', '% of limit (rad/s)', 'v of the plan over the limits of the robot'],
  ['torques', 'Joint torques', '% of limit (N m)', 'tau of the plan over the limits of the robot, at the joint\'s speed if its motor has a line'],
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

/* Per cent of what the motor can do at this rate: against the motion its full limit, and along with
   it what its torque-speed line leaves. */
function shareOfTorque(joint, torque, rate) {
  let limit = joint.effort || Infinity;
  if (joint.line) {
    const forward = torque < 0 ? -rate : rate;
    const driving = joint.line.stall_torque * (1 - forward / joint.line.no_load_speed);
    limit = Math.min(Math.max(driving, 0), limit);
  }
  if (torque === 0) return 0;
  const share = 100 * torque / limit;
  return Math.min(Math.max(share, -kMostShare), kMostShare);
}

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
      plot.time = (phase, k) => motion.time(phase, k);
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
    const x = new THREE.Vector3(1, 0, 0).applyQuaternion(
        this.motion.rotationOfRoot(segment.phases[0], 0)).setZ(0).normalize();
    return {forward: x, left: new THREE.Vector3(-x.y, x.x, 0)};
  }

  showJoints() {
    const {columns} = this.motion;
    const degrees = (joint, value) => joint.prismatic
        ? fixed(value, 3) + ' m' : fixed(value * 180 / Math.PI, 0) + '°';
    this.showShares('positions', (joint, i) => joint.range && {
      share: (phase, k) => {
        const [low, high] = joint.range;
        return 100 * (2 * this.motion.at(phase, columns.q + 7 + i, k) - low - high) / (high - low);
      },
      text: (share) => degrees(
          joint, (joint.range[0] + joint.range[1] + share / 100 *
                  (joint.range[1] - joint.range[0])) / 2),
    });
    this.showShares('speeds', (joint, i) => joint.speed && {
      share: (phase, k) => 100 * this.motion.at(phase, columns.rates + i, k) / joint.speed,
      text: (share) =>
          fixed(share / 100 * joint.speed, 1) + (joint.prismatic ? ' m/s' : ''),
    });
    this.showShares('torques', (joint, i) => {
      if (!joint.effort && !joint.line) return null;
      const torque = (phase, k) => this.motion.at(phase, columns.torques + i, k);
      const rate = (phase, k) => this.motion.at(phase, columns.rates + i, k);
      return {
        share: (phase, k) => shareOfTorque(joint, torque(phase, k), rate(phase, k)),
        reading: torque,
        text: (value) => fixed(value, 0) + (joint.prismatic ? ' N' : ''),
      };
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
        value: shares[joint].share,
        reading: shares[joint].reading,
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
      for (let k = 0; k < phase.count; ++k) highest = Math.max(highest, Math.abs(share(phase, k)));
    }
    return highest;
  }

  /* The forces at a contact's points at a knot, [x, y, z] each; null if it does not bear. */
  forcesOf(phase, k, contact) {
    const place = phase.contacts.indexOf(contact);
    if (place < 0) return null;
    const before = phase.bearing.slice(0, place).reduce((sum, points) => sum + points.length, 0);
    const at = (point, axis) => this.motion.at(
        phase, this.motion.columns.forces + 3 * (before + point) + axis, k);
    return phase.bearing[place].map((_, i) => [at(i, 0), at(i, 1), at(i, 2)]);
  }

  showContacts() {
    const {weight} = this.data;
    const bearing = this.data.contacts.map((contact, i) => i)
        .filter((i) => this.phases.some((phase) => phase.contacts.includes(i)));
    const curves = (ofPoints, text) => bearing.map((contact) => ({
      label: this.data.contacts[contact].name,
      colour: limbColour(contact),
      dashed: contact % 2 > 0,  // left and right often coincide
      value: (phase, k) => {
        const forces = this.forcesOf(phase, k, contact);
        return forces && ofPoints(forces);
      },
      text,
    }));
    const marks = this.phases.filter((phase) => phase.impulses.length).map((phase) => ({
      t: phase.begin, text: impulseText(phase), colour: kImpulseColour}));
    this.put('forces', {
      curves: curves((forces) => forces.reduce((sum, [, , z]) => sum + z, 0) * 100 / weight,
                     (share) => fixed(share / 100 * weight, 0)),
      limits: [{y: 100, text: 'weight', colour: '#667180'}],
      marks,
      include: [0],
    });
    const share = ([x, y, z]) => z < kLeastNormal ? 0
        : 100 * Math.hypot(x, y) / (this.data.friction * z);
    this.put('friction', {
      curves: curves((forces) => Math.max(...forces.map(share)), (n) => fixed(n, 0)),
      limits: [{y: 100, text: ''}],
      range: [0, 108],
    });
  }

  showMargins() {
    const {columns} = this.motion;
    const contents = marginContents((column, scale) => (phase, k) => {
      const value = this.motion.valueOfKnot(phase, columns.margins + column, k);
      return value === null ? null : scale * value;
    });
    for (const [name, content] of Object.entries(contents)) this.put(name, content);
  }

  showWhole() {
    const {columns} = this.motion, {forward, left} = this.frame;
    const start = this.motion.centreOfKnot(this.segment.phases[0], 0);
    const along = (first, axis, from) => (phase, k) => {
      const at = (i) => this.motion.at(phase, first + i, k);
      return (at(0) - from.x) * axis.x + (at(1) - from.y) * axis.y + (at(2) - from.z) * axis.z;
    };
    const centre = (axis, from) => along(columns.centre, axis, from);
    const up = new THREE.Vector3(0, 0, 1), none = new THREE.Vector3();
    const one = (label, colour, value, digits) =>
        ({label, colour, value, text: (n) => fixed(n, digits)});
    this.put('height', {curves: [one('height', '#1d2530', centre(up, none), 3)]});
    this.put('forward', {curves: [one('forward', '#1d2530', centre(forward, start), 3)]});
    const momentum = (first, axis) => along(columns.momenta + first, axis, none);
    const three = (first, names) => [forward, left, up].map(
        (axis, i) => one(names[i], kCurveColours[i], momentum(first, axis), 1));
    this.put('linear', {curves: three(0, ['forward', 'left', 'up'])});
    this.put('angular', {curves: three(3, ['roll', 'pitch', 'yaw'])});
  }

  /* Centre of mass, zero moment point and capture point in the world, and the reserve. */
  showBalance() {
    const {columns} = this.motion;
    const curve = (label, colour, value) => ({label, colour, value, text: (n) => fixed(n, 3)});
    const balance = (column) => (phase, k) =>
        this.motion.valueOfKnot(phase, columns.balance + column, k);
    const inWorld = (axis) => ({curves: [
      curve('z.m.p.', kZmpColour, balance(axis)),
      curve('capture point', kCaptureColour, balance(4 + axis)),
      curve('c.o.m.', kCentreColour,
            (phase, k) => this.motion.at(phase, columns.centre + axis, k)),
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
