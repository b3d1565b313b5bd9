'use strict';

/* The motion of a plan: its knots, and the poses of links at any time between them. */

function decodeBase64(text) {
  const bytes = atob(text);
  const buffer = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; ++i) buffer[i] = bytes.charCodeAt(i);
  return buffer.buffer;
}
const decodeFloats = (text) => new Float32Array(decodeBase64(text));
const decodeIntegers = (text) => new Int32Array(decodeBase64(text));

/* Numbers in rows. */
class Table {
  constructor(rows, columns) {
    this.columns = columns;
    this.numbers = new Float32Array(rows * columns);
  }
  at(row, column) { return this.numbers[row * this.columns + column]; }
}

/* Pose as stored: quaternion w, x, y, z, then position. */
function poseMatrix(pose) {
  return new THREE.Matrix4().compose(
      new THREE.Vector3(pose[4], pose[5], pose[6]),
      new THREE.Quaternion(pose[1], pose[2], pose[3], pose[0]), new THREE.Vector3(1, 1, 1));
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
    this.stride = 8 + this.joints.length;
    this.expandCourses(data);
    this.gravity = data.gravity;
    this.phases = [];
    this.segments = [];
    data.segments.forEach((segment, index) => {
      const phases = segment.phases.map((phase) => this.addPhase(phase, segment, index));
      this.phases.push(...phases);
      if (phases.length) this.segments.push(this.addSegment(segment, phases));
    });
    this.legs = this.joinSegments();
    this.linkPoses = data.links.map(() => new THREE.Matrix4());
    this.begin = this.phases.length ? this.phases[0].begin : 0;
    this.end = this.phases.length ? this.phases[this.phases.length - 1].end : 0;
    this.turn = new THREE.Quaternion();
    this.rotation = new THREE.Matrix4();
  }

  /* Of every phase: what each number does from knot to knot, as the index of a course that others
     may share. A course of one number stays. */
  expandCourses(data) {
    const phases = [].concat(...data.segments.map((segment) => segment.phases));
    const pointsOf = (phase) => phase.points.reduce((sum, points) => sum + points.length, 0);
    const rows = phases.reduce((sum, phase) => sum + phase.count, 0);
    const points = phases.reduce((sum, phase) => sum + phase.count * pointsOf(phase), 0);
    const knots = new Table(rows, this.stride), centres = new Table(rows, 3);
    this.momenta = new Table(rows, 6);
    this.rates = new Table(rows, this.joints.length);
    this.torques = new Table(rows, this.joints.length);
    this.balance = new Table(rows, 6);
    this.margins = new Table(rows, 7);
    this.knots = knots.numbers;
    this.centres = centres.numbers;
    this.forces = new Float32Array(3 * points);
    const begins = decodeIntegers(data.courses.begins);
    const numbers = decodeFloats(data.courses.numbers), indices = decodeIntegers(data.indices);
    let next = 0;
    for (const phase of phases) {
      const fill = (target, first, columns) => {
        for (let column = 0; column < columns; ++column) {
          const index = indices[next++], begin = begins[index];
          const pace = begins[index + 1] - begin > 1 ? 1 : 0;
          for (let k = 0; k < phase.count; ++k) {
            target[first + k * columns + column] = numbers[begin + pace * k];
          }
        }
      };
      for (const table of [knots, centres, this.momenta, this.rates, this.torques, this.balance,
                           this.margins]) {
        fill(table.numbers, phase.first * table.columns, table.columns);
      }
      fill(this.forces, phase.forces, 3 * pointsOf(phase));
    }
  }

  addPhase(phase, segment, index) {
    return {
      segment: index,
      action: segment.action,
      name: phase.name,
      impulses: this.vectors(phase.impulses || []),
      contacts: phase.contacts,
      first: phase.first,
      count: phase.count,
      forces: phase.forces,
      bearing: phase.points,
      points: phase.points.reduce((sum, points) => sum + points.length, 0),
      begin: this.knots[phase.first * this.stride],
      end: this.knots[(phase.first + phase.count - 1) * this.stride],
    };
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

  /* The knot of the phase before t, and how far t lies towards the next one (0 to 1). */
  locate(phase, t) {
    let low = phase.first, high = phase.first + phase.count - 2;
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.knots[middle * this.stride] <= t) low = middle; else high = middle - 1;
    }
    const t0 = this.knots[low * this.stride], t1 = this.knots[(low + 1) * this.stride];
    return {knot: low, fraction: Math.min(1, Math.max(0, (t - t0) / (t1 - t0)))};
  }

  /* Poses of all links at t: slerp of the root, linear in between for everything else. */
  poseLinks(t, phase) {
    const {knot, fraction} = this.locate(phase, t);
    const k0 = knot * this.stride + 1, k1 = k0 + this.stride, q = this.knots;
    const mix = (i) => q[k0 + i] + fraction * (q[k1 + i] - q[k0 + i]);
    const root = new THREE.Quaternion(q[k0 + 1], q[k0 + 2], q[k0 + 3], q[k0]).normalize();
    root.slerp(new THREE.Quaternion(q[k1 + 1], q[k1 + 2], q[k1 + 3], q[k1]).normalize(), fraction);
    this.linkPoses[0].makeRotationFromQuaternion(root).setPosition(mix(4), mix(5), mix(6));
    this.joints.forEach((joint, i) => this.poseLink(i + 1, joint, mix(7 + i)));
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
    const {knot, fraction} = this.locate(phase, t);
    const k0 = phase.forces + 3 * phase.points * (knot - phase.first), k1 = k0 + 3 * phase.points;
    const forces = [];
    for (let i = 0; i < 3 * phase.points; i += 3) {
      const at = (j) => this.forces[k0 + j] + fraction * (this.forces[k1 + j] - this.forces[k0 + j]);
      forces.push(new THREE.Vector3(at(i), at(i + 1), at(i + 2)));
    }
    return forces;
  }

  centreOfKnot(knot) {
    return new THREE.Vector3(...this.centres.subarray(3 * knot, 3 * knot + 3));
  }

  /* The centre of mass. */
  centreAt(t, phase) {
    const {knot, fraction} = this.locate(phase, t);
    return this.centreOfKnot(knot).lerp(this.centreOfKnot(knot + 1), fraction);
  }

  /* A number of the balance at a knot: zero moment point x, y, z, its distance from the edge of the
     support, capture point x, y. Null if there is none. */
  balanceOfKnot(knot, column) {
    const value = this.balance.at(knot, column);
    return isNaN(value) ? null : value;
  }

  /* Zero moment point and capture point on the ground; null while nothing bears. */
  balanceAt(t, phase) {
    const {knot, fraction} = this.locate(phase, t);
    const at = (column) => this.balance.at(knot, column) + fraction *
        (this.balance.at(knot + 1, column) - this.balance.at(knot, column));
    if (isNaN(at(0))) return null;
    return {zmp: new THREE.Vector3(at(0), at(1), at(2)),
            capture: new THREE.Vector3(at(4), at(5), at(2))};
  }

  /* Phases without contact, with the centre of mass at launch and landing. */
  flights() {
    return this.phases.filter((phase) => !phase.contacts.length).map((phase) => ({
      phase,
      duration: phase.end - phase.begin,
      launch: this.centreOfKnot(phase.first),
      landing: this.centreOfKnot(phase.first + phase.count - 1),
    }));
  }

  /* Where and when each contact touched down. */
  touchdowns() {
    const found = [];
    let previous = [];
    for (const phase of this.phases) {
      const fresh = phase.contacts.filter((c) => !previous.includes(c));
      if (fresh.length) this.poseLinks(phase.begin, phase);
      for (const contact of fresh) found.push({contact, points: this.contactPoints(contact)});
      previous = phase.contacts;
    }
    return found;
  }

  /* Positions of the root at every knot, one list per segment. */
  route() {
    const lines = [];
    for (const phase of this.phases) {
      if (!lines[phase.segment]) lines[phase.segment] = {action: phase.action, points: []};
      for (let k = phase.first; k < phase.first + phase.count; ++k) {
        const q = k * this.stride + 1;
        lines[phase.segment].points.push(
            new THREE.Vector3(this.knots[q + 4], this.knots[q + 5], this.knots[q + 6]));
      }
    }
    return lines.filter((line) => line);
  }
}
