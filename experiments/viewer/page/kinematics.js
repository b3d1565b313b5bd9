'use strict';

/* The motion of a plan: its knots, and the poses of links at any time between them. */

const kMostKnotsSeen = 40000;  // as lines

function decodeBase64(text) {
  const bytes = atob(text);
  const buffer = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) buffer[i] = bytes.charCodeAt(i);
  return buffer.buffer;
}
const decodeFloats = (text) => new Float32Array(decodeBase64(text));
const decodeIntegers = (text) => new Int32Array(decodeBase64(text));

/* Pose as stored: quaternion w, x, y, z, then position. */
function poseMatrix(pose) {
  return new THREE.Matrix4().compose(
      new THREE.Vector3(pose[4], pose[5], pose[6]),
      new THREE.Quaternion(pose[1], pose[2], pose[3], pose[0]), new THREE.Vector3(1, 1, 1));
}

/* Where the numbers of a knot begin, as experiments/viewer/viewer_motion.h writes them. */
function columnsOf(joints) {
  const sizes = {t: 1, q: 7 + joints, centre: 3, momenta: 6, rates: joints, torques: joints,
                 balance: 6, margins: 7};
  const columns = {};
  let next = 0;
  for (const [name, size] of Object.entries(sizes)) {
    columns[name] = next;
    next += size;
  }
  return {...columns, forces: next};
}

class Motion {
  constructor(data) {
    this.joints = data.joints.map((joint) => ({
      parent: joint.parent,
      prismatic: joint.prismatic,
      axis: new THREE.Vector3(...joint.axis),
      inParent: poseMatrix(joint.pose),
    }));
    this.contacts = data.contacts;
    this.columns = columnsOf(this.joints.length);
    this.begins = decodeIntegers(data.courses.begins);
    this.numbers = decodeFloats(data.courses.numbers);
    this.indices = decodeIntegers(data.indices);
    this.next = 0;  // of the indices, while phases are added
    this.gravity = data.gravity;
    this.phases = [];
    this.segments = [];
    data.segments.forEach((segment, index) => {
      const phases = segment.phases.map((phase) => this.addPhase(phase, segment, index));
      for (const phase of phases) this.phases.push(phase);
      if (phases.length) this.segments.push(this.addSegment(segment, phases));
    });
    this.chains = data.contacts.map((contact) => this.chainTo(contact.link));
    this.legs = this.joinSegments();
    this.linkPoses = data.links.map(() => new THREE.Matrix4());
    this.begin = this.phases.length ? this.phases[0].begin : 0;
    this.end = this.phases.length ? this.phases[this.phases.length - 1].end : 0;
    this.turn = new THREE.Quaternion();
    this.rotation = new THREE.Matrix4();
  }

  /* A number at knot k of a phase. The page's data stay packed: each column of a phase is the index
     of a course that others may share; a course of one number stays. */
  at(phase, column, k) {
    const index = this.indices[phase.first + column], begin = this.begins[index];
    return this.numbers[this.begins[index + 1] - begin > 1 ? begin + k : begin];
  }
  time(phase, k) { return this.at(phase, 0, k); }

  /* What t lies between: knots k and k + 1, `fraction` of the way. */
  between(phase, column, {k, fraction}) {
    const before = this.at(phase, column, k);
    return before + fraction * (this.at(phase, column, k + 1) - before);
  }

  addPhase(phase, segment, index) {
    const points = phase.points.reduce((sum, points) => sum + points.length, 0);
    const added = {
      segment: index,
      action: segment.action,
      name: phase.name,
      impulses: this.vectors(phase.impulses || []),
      contacts: phase.contacts,
      first: this.next,
      count: phase.count,
      bearing: phase.points,
      points,
    };
    this.next += this.columns.forces + 3 * points;
    added.begin = this.time(added, 0);
    added.end = this.time(added, phase.count - 1);
    return added;
  }

  /* The joints on the way from the root to a link, in this order. */
  chainTo(link) {
    return link === 0 ? [] : [...this.chainTo(this.joints[link - 1].parent), link - 1];
  }

  addSegment(segment, phases) {
    return {
      action: segment.action,
      phases,
      begin: phases[0].begin,
      end: phases[phases.length - 1].end,
      flies: phases.some((phase) => !phase.contacts.length),
    };
  }

  /* Segments of one action in a row, as one. */
  joinSegments() {
    const legs = [];
    for (const segment of this.segments) {
      const last = legs[legs.length - 1];
      if (last && last.action === segment.action && !segment.flies) last.end = segment.end;
      else legs.push({action: segment.action, begin: segment.begin, end: segment.end});
    }
    return legs;
  }

  vectors(numbers) {
    const result = [];
    for (let i = 0; i < numbers.length; i += 3) {
      result.push(new THREE.Vector3(numbers[i], numbers[i + 1], numbers[i + 2]));
    }
    return result;
  }

  /* Of things in a row, each with a begin, the last that has begun at time t. */
  static lastBegun(things, t) {
    let low = 0, high = things.length - 1;
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (things[middle].begin <= t) low = middle; else high = middle - 1;
    }
    return things[low];
  }
  phaseAt(t) { return Motion.lastBegun(this.phases, t); }
  segmentAt(t) { return Motion.lastBegun(this.segments, t); }

  /* The knot k of the phase before t, and how far t lies towards the next one (0 to 1). */
  locate(phase, t) {
    let low = 0, high = phase.count - 2;
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.time(phase, middle) <= t) low = middle; else high = middle - 1;
    }
    const t0 = this.time(phase, low), t1 = this.time(phase, low + 1);
    return {k: low, fraction: Math.min(1, Math.max(0, (t - t0) / (t1 - t0)))};
  }

  rotationOfRoot(phase, k) {
    const q = (i) => this.at(phase, this.columns.q + i, k);
    return new THREE.Quaternion(q(1), q(2), q(3), q(0)).normalize();
  }

  /* Poses at t of the links behind these joints: slerp of the root, linear in between for
     everything else. */
  poseBehind(joints, t, phase) {
    const place = this.locate(phase, t), {q} = this.columns;
    const root = this.rotationOfRoot(phase, place.k);
    if (place.fraction > 0) root.slerp(this.rotationOfRoot(phase, place.k + 1), place.fraction);
    const p = (i) => this.between(phase, q + 4 + i, place);
    this.linkPoses[0].makeRotationFromQuaternion(root).setPosition(p(0), p(1), p(2));
    for (const i of joints) {
      this.poseLink(i + 1, this.joints[i], this.between(phase, q + 7 + i, place));
    }
  }

  poseLinks(t, phase) {
    this.poseBehind(this.joints.keys(), t, phase);
    return this.linkPoses;
  }

  poseLink(link, joint, value) {
    const pose = this.linkPoses[link];
    pose.multiplyMatrices(this.linkPoses[joint.parent], joint.inParent);
    if (joint.prismatic) {
      this.rotation.makeTranslation(
          value * joint.axis.x, value * joint.axis.y, value * joint.axis.z);
    } else {
      this.rotation.makeRotationFromQuaternion(this.turn.setFromAxisAngle(joint.axis, value));
    }
    pose.multiply(this.rotation);
  }

  /* World positions of a contact's points at the poses last computed. */
  contactPoints(contact) {
    const {link, points} = this.contacts[contact];
    return points.map((p) => new THREE.Vector3(...p).applyMatrix4(this.linkPoses[link]));
  }

  /* The same for all points that bear in a phase, in the order of its forces. */
  bearingPoints(phase) {
    return [].concat(...phase.contacts.map((contact, i) => {
      const points = this.contactPoints(contact);
      return phase.bearing[i].map((point) => points[point]);
    }));
  }

  /* Forces (N) at the points of the phase's contacts, in their order. */
  contactForces(t, phase) {
    const place = this.locate(phase, t), forces = [];
    for (let i = 0; i < 3 * phase.points; i += 3) {
      const at = (axis) => this.between(phase, this.columns.forces + i + axis, place);
      forces.push(new THREE.Vector3(at(0), at(1), at(2)));
    }
    return forces;
  }

  centreOfKnot(phase, k) {
    const at = (axis) => this.at(phase, this.columns.centre + axis, k);
    return new THREE.Vector3(at(0), at(1), at(2));
  }

  /* The centre of mass. */
  centreAt(t, phase) {
    const {k, fraction} = this.locate(phase, t);
    return this.centreOfKnot(phase, k).lerp(this.centreOfKnot(phase, k + 1), fraction);
  }

  /* A number at a knot, or null where it is not a number. */
  valueOfKnot(phase, column, k) {
    const value = this.at(phase, column, k);
    return isNaN(value) ? null : value;
  }

  /* Zero moment point and capture point on the ground; null while nothing bears. */
  balanceAt(t, phase) {
    const place = this.locate(phase, t);
    const at = (column) => this.between(phase, this.columns.balance + column, place);
    if (isNaN(at(0))) return null;
    return {zmp: new THREE.Vector3(at(0), at(1), at(2)),
            capture: new THREE.Vector3(at(4), at(5), at(2))};
  }

  /* Phases without contact, with the centre of mass at launch and landing. */
  flights() {
    return this.phases.filter((phase) => !phase.contacts.length).map((phase) => ({
      phase,
      duration: phase.end - phase.begin,
      launch: this.centreOfKnot(phase, 0),
      landing: this.centreOfKnot(phase, phase.count - 1),
    }));
  }

  /* Where and when each contact touched down. */
  touchdowns() {
    const found = [];
    let previous = [];
    for (const phase of this.phases) {
      for (const contact of phase.contacts.filter((c) => !previous.includes(c))) {
        this.poseBehind(this.chains[contact], phase.begin, phase);
        found.push({contact, points: this.contactPoints(contact)});
      }
      previous = phase.contacts;
    }
    return found;
  }

  /* Calls see(phase, k) for the ends of every phase and for knots between them, of long plans only
     for some. */
  forSomeKnots(see) {
    const all = this.phases.reduce((sum, phase) => sum + phase.count, 0);
    const step = Math.max(1, Math.round(all / kMostKnotsSeen));
    for (const phase of this.phases) {
      for (let k = 0; k < phase.count - 1; k += step) see(phase, k);
      see(phase, phase.count - 1);
    }
  }

  /* Positions of the root, one list per segment. */
  route() {
    const lines = [];
    this.forSomeKnots((phase, k) => {
      if (!lines[phase.segment]) lines[phase.segment] = {action: phase.action, points: []};
      const p = (axis) => this.at(phase, this.columns.q + 4 + axis, k);
      lines[phase.segment].points.push(new THREE.Vector3(p(0), p(1), p(2)));
    });
    return lines.filter((line) => line);
  }
}
