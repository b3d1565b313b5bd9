'use strict';

/* What keeps the robot from falling: the support polygon, the zero moment point, the capture point
   and the load of every patch that bears. */

const kSupportColour = '#14b8a6';
const kZmpColour = '#0b7285';
const kCaptureColour = '#9a6700';
const kLoadScale = 0.5;  // m per weight of the robot

/* The convex hull of points seen from above, counter-clockwise (Andrew's monotone chain). */
function hullFromAbove(points) {
  const sorted = points.slice().sort((a, b) => a.x - b.x || a.y - b.y);
  const turn = (a, b, c) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const chain = (list) => {
    const kept = [];
    for (const point of list) {
      while (kept.length > 1 && turn(kept[kept.length - 2], kept[kept.length - 1], point) <= 0) {
        kept.pop();
      }
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return sorted.length < 2 ? sorted : chain(sorted).concat(chain(sorted.reverse()));
}

/* A flat ring with a white rim. */
function ringOnGround(colour) {
  const group = new THREE.Group();
  const ring = (inner, outer, shade, order) => {
    const mesh = new THREE.Mesh(new THREE.RingBufferGeometry(inner, outer, 32), shining(shade));
    mesh.material.side = THREE.DoubleSide;
    mesh.renderOrder = order;
    group.add(mesh);
  };
  ring(0.014, 0.046, '#ffffff', 9);
  ring(0.02, 0.04, colour, 10);
  return group;
}

/* A post as high as the weight, filled up to the load that the patch carries. */
class LoadBar {
  constructor(colour) {
    this.group = new THREE.Group();
    const post = (radius, shade, opacity, order) => {
      const geometry = new THREE.CylinderBufferGeometry(radius, radius, 1, 16)
                           .rotateX(Math.PI / 2).translate(0, 0, 0.5);
      const mesh = new THREE.Mesh(geometry, shining(shade, opacity));
      mesh.renderOrder = order;
      this.group.add(mesh);
      return mesh;
    };
    post(0.02, '#ffffff', 0.6, 7).scale.z = kLoadScale;
    this.filled = post(0.02, colour, 0.9, 8);
  }

  show(place, share) {
    this.group.position.copy(place);
    this.filled.visible = share > 1e-3;
    if (this.filled.visible) this.filled.scale.z = share * kLoadScale;
  }
}

class BalanceMarks {
  constructor(motion, data) {
    this.motion = motion;
    this.weight = data.weight;
    this.group = new THREE.Group();
    this.group.visible = false;
    this.face = new THREE.Mesh(new THREE.BufferGeometry(), shining(kSupportColour, 0.35));
    this.face.material.side = THREE.DoubleSide;
    this.edge = new THREE.LineLoop(new THREE.BufferGeometry(), lineMaterial(kSupportColour));
    Object.assign(this.edge.material, {depthTest: false, transparent: true});
    this.edge.renderOrder = 3;
    this.zmp = new THREE.Group();
    const rim = ball(new THREE.Vector3(), 0.034, '#ffffff');
    this.zmp.add(rim, ball(new THREE.Vector3(), 0.026, kZmpColour));
    this.zmp.children.forEach((part, i) => { part.renderOrder = 11 + i; });
    this.capture = ringOnGround(kCaptureColour);
    this.bars = data.contacts.map((_, i) => new LoadBar(limbColour(i)));
    const below = new THREE.Group().add(this.face);
    this.group.add(below, this.edge, this.capture, this.zmp,
                   ...this.bars.map((bar) => bar.group));
    // The order of groups comes first. Patches have 1: the face is below them, the rest above.
    this.group.traverse((part) => { if (part.isGroup && part !== below) part.renderOrder = 2; });
  }

  /* Uses the poses last computed. */
  update(t, phase) {
    if (!this.group.visible) return;
    const points = this.motion.bearingPoints(phase);
    this.showSupport(points);
    this.showLoads(t, phase, points);
    const balance = this.motion.balanceAt(t, phase);
    this.zmp.visible = this.capture.visible = balance !== null;
    if (!balance) return;
    this.zmp.position.copy(balance.zmp);
    this.capture.position.copy(balance.capture);
    this.capture.position.z += kLift;
  }

  showSupport(points) {
    const hull = hullFromAbove(points);
    hull.forEach((corner) => { corner.z += kLift; });
    const fan = [];
    for (let i = 1; i + 1 < hull.length; ++i) fan.push(hull[0], hull[i], hull[i + 1]);
    this.replace(this.face, fan);
    this.replace(this.edge, hull);
  }

  replace(mesh, points) {
    mesh.geometry.dispose();
    mesh.geometry = new THREE.BufferGeometry().setFromPoints(points);
    mesh.visible = points.length > 1;
  }

  showLoads(t, phase, points) {
    const forces = this.motion.contactForces(t, phase);
    let next = 0;
    this.bars.forEach((bar) => { bar.group.visible = false; });
    phase.contacts.forEach((contact, i) => {
      const count = phase.bearing[i].length, centre = new THREE.Vector3();
      let load = 0;
      for (let k = next; k < next + count; ++k) {
        centre.add(points[k]);
        load += forces[k].z;
      }
      next += count;
      this.bars[contact].group.visible = true;
      this.bars[contact].show(centre.divideScalar(count), load / this.weight);
    });
  }
}
