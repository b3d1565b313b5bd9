'use strict';

/* What jumps add to the drawing: the arcs of flights, the way of the centre of mass, impulses. */

const kArcColour = '#8a0f63';
const kCentreColour = '#1d2530';
const kImpulseColour = '#ff5a1f';
const kImpulseScale = 1 / 8;  // m per N s
const kImpactShown = 0.35;    // s, after the impact

/* Drawn through everything before it. */
function shining(colour, opacity = 1) {
  return new THREE.MeshBasicMaterial(
      {color: colour, transparent: true, opacity, depthTest: false});
}

/* Points of the parabola that takes `duration` seconds. */
function parabola({launch, landing, duration}, gravity, pieces) {
  const points = [];
  for (let i = 0; i <= pieces; ++i) {
    const s = i / pieces;
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

const kMostNamedFlights = 30;

/* Adds a ball with a white rim to the marks of flights. */
function addArcEnd(parts, point, pieces) {
  [['rim', 0.034, '#ffffff', 3], ['end', 0.025, kArcColour, 4]].forEach(
      ([name, radius, colour, order]) => {
        const sphere = new THREE.SphereBufferGeometry(radius, pieces, pieces)
                           .translate(point.x, point.y, point.z);
        parts.add(name, sphere, null, (geometry) => shiningMesh(geometry, colour, 1, order));
      });
}

/* A word to the side of a point to which `away` points. */
function arcWord(point, text, away) {
  const word = label(text, kArcColour, 0.62);
  word.position.copy(point).addScaledVector(away, 0.22);
  word.position.z += 0.06;
  word.renderOrder = 4;
  return word;
}

function shiningMesh(geometry, colour, opacity, order) {
  const mesh = new THREE.Mesh(geometry, shining(colour, opacity));
  mesh.renderOrder = order;
  return mesh;
}

/* The parabola of the centre of mass of every flight, launch and landing marked; of a few flights
   with words. */
function flightArcs(motion) {
  const flights = motion.flights(), parts = new MergedParts(), words = [];
  const isFew = flights.length <= kMostNamedFlights;
  for (const flight of flights) {
    parts.add('arc', tubeAlong(parabola(flight, motion.gravity, isFew ? 32 : 8), 0.011), null,
              (geometry) => shiningMesh(geometry, kArcColour, 0.9, 3));
    addArcEnd(parts, flight.launch, isFew ? 16 : 4);
    addArcEnd(parts, flight.landing, isFew ? 16 : 4);
    if (!isFew) continue;
    const ahead = flight.landing.clone().sub(flight.launch).setZ(0);
    if (ahead.lengthSq() > 0) ahead.normalize();
    words.push(arcWord(flight.launch, 'launch', ahead.clone().negate()),
               arcWord(flight.landing, 'landing', ahead));
  }
  const group = parts.group();
  words.forEach((word) => group.add(word));
  return group;
}

/* The way of the centre of mass, and where on it it is. */
class CentreOfMass {
  constructor(motion) {
    this.motion = motion;
    this.group = new THREE.Group();
    const points = [];
    motion.forSomeKnots((phase, k) => points.push(motion.centreOfKnot(phase, k)));
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
