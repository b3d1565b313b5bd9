'use strict';

/* What jumps add to the drawing: the arcs of flights, the way of the centre of mass, impulses. */

const kArcColour = '#8a0f63';
const kCentreColour = '#1d2530';
const kImpulseColour = '#ff5a1f';
const kImpulseScale = 1 / 8;  // m per N s
const kImpactShown = 0.35;    // s, after the impact
const kArcPieces = 32;

/* Drawn through everything before it. */
function shining(colour, opacity = 1) {
  return new THREE.MeshBasicMaterial(
      {color: colour, transparent: true, opacity, depthTest: false});
}

/* Points of the parabola that takes `duration` seconds. */
function parabola({launch, landing, duration}, gravity) {
  const points = [];
  for (let i = 0; i <= kArcPieces; ++i) {
    const s = i / kArcPieces;
    const point = launch.clone().lerp(landing, s);
    point.z += gravity / 2 * duration * duration * s * (1 - s);
    points.push(point);
  }
  return points;
}

function ball(point, radius, colour) {
  const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 20, 14), shining(colour));
  mesh.position.copy(point);
  mesh.renderOrder = 4;
  return mesh;
}

/* A ball with a white rim and a word, to the side to which `away` points. */
function arcEnd(point, text, away) {
  const group = new THREE.Group();
  const rim = ball(point, 0.034, '#ffffff');
  rim.renderOrder = 3;
  const name = label(text, kArcColour, 0.62);
  name.position.copy(point).addScaledVector(away, 0.22);
  name.position.z += 0.06;
  name.renderOrder = 4;
  group.add(rim, ball(point, 0.025, kArcColour), name);
  return group;
}

/* The parabola of the centre of mass of every flight, launch and landing marked. */
function flightArcs(motion) {
  const group = new THREE.Group();
  for (const flight of motion.flights()) {
    const curve = new THREE.CatmullRomCurve3(parabola(flight, motion.gravity));
    const tube = new THREE.Mesh(
        new THREE.TubeBufferGeometry(curve, 2 * kArcPieces, 0.011, 10), shining(kArcColour, 0.9));
    tube.renderOrder = 3;
    const ahead = flight.landing.clone().sub(flight.launch).setZ(0);
    if (ahead.lengthSq() > 0) ahead.normalize();
    group.add(tube, arcEnd(flight.launch, 'launch', ahead.clone().negate()),
              arcEnd(flight.landing, 'landing', ahead));
  }
  return group;
}

/* The way of the centre of mass, and where on it it is. */
class CentreOfMass {
  constructor(motion) {
    this.motion = motion;
    this.group = new THREE.Group();
    const points = [];
    for (const phase of motion.phases) {
      for (let k = phase.first; k < phase.first + phase.count; ++k) {
        points.push(motion.centreOfKnot(k));
      }
    }
    if (!points.length) return;
    this.group.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(points),
                                  lineMaterial(kCentreColour, 0.8)));
    this.marker = new THREE.Group();
    this.marker.renderOrder = 3;
    const rim = ball(new THREE.Vector3(), 0.03, '#ffffff');
    rim.renderOrder = 5;
    const core = ball(new THREE.Vector3(), 0.022, kCentreColour);
    core.renderOrder = 6;
    this.marker.add(rim, core);
    this.group.add(this.marker);
  }

  update(t, phase) {
    if (this.marker) this.marker.position.copy(this.motion.centreAt(t, phase));
  }
}

/* An arrow whose shaft is a cylinder: lines cannot be thick. */
function thickArrow(from, impulse, opacity) {
  const length = impulse.length() * kImpulseScale, head = Math.min(0.09, 0.5 * length);
  const material = shining(kImpulseColour, opacity);
  const arrow = new THREE.Group();
  const shaft = new THREE.CylinderBufferGeometry(0.013, 0.013, length - head, 12)
                    .translate(0, (length - head) / 2, 0);
  const tip = new THREE.ConeBufferGeometry(0.034, head, 16).translate(0, length - head / 2, 0);
  for (const geometry of [shaft, tip]) {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.renderOrder = 7;
    arrow.add(mesh);
  }
  arrow.position.copy(from);
  arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), impulse.clone().normalize());
  return arrow;
}
