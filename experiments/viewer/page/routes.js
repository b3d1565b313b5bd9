'use strict';

/* Ways as lines and tubes. They have so many points at most that plans of an hour are drawn as
   quickly as those of a minute; the longer the plan, the wider the steps. */

const kFinestStep = 0.02;  // m
const kMostSteps = 6000;   // of a route
const kTubeSides = 7;

/* Points of a line at least `step` apart, and its last one. */
function spaced(points, step) {
  const kept = [];
  for (const point of points) {
    if (!kept.length || kept[kept.length - 1].distanceTo(point) > step) kept.push(point);
  }
  const last = points[points.length - 1];
  if (kept.length > 1 && kept[kept.length - 1] !== last) kept[kept.length - 1] = last;
  return kept;
}

function lengthOf(points) {
  let length = 0;
  for (let i = 1; i < points.length; ++i) length += points[i].distanceTo(points[i - 1]);
  return length;
}

/* A tube along a line of points: a ring of corners at each, across the way there. */
function tubeAlong(points, radius) {
  const corners = [], triangles = [];
  const up = new THREE.Vector3(0, 0, 1), along = new THREE.Vector3();
  const side = new THREE.Vector3(), above = new THREE.Vector3();
  points.forEach((point, i) => {
    along.subVectors(points[Math.min(i + 1, points.length - 1)], points[Math.max(i - 1, 0)]);
    side.crossVectors(up, along);
    if (side.lengthSq() < 1e-12) side.set(1, 0, 0);
    side.normalize();
    above.crossVectors(along, side).normalize();
    for (let s = 0; s < kTubeSides; ++s) {
      const angle = 2 * Math.PI * s / kTubeSides;
      const [a, b] = [radius * Math.cos(angle), radius * Math.sin(angle)];
      corners.push(point.x + a * side.x + b * above.x, point.y + a * side.y + b * above.y,
                   point.z + a * side.z + b * above.z);
      if (i === 0) continue;
      const here = i * kTubeSides + s, next = i * kTubeSides + (s + 1) % kTubeSides;
      triangles.push(here - kTubeSides, next - kTubeSides, here,
                     next - kTubeSides, next, here);
    }
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(triangles);
  return geometry;
}

/* The pelvis' way, coloured by action. */
function routeTubes(motion) {
  const lines = motion.route(), parts = new MergedParts();
  const length = lines.reduce((sum, line) => sum + lengthOf(line.points), 0);
  const step = Math.max(kFinestStep, length / kMostSteps);
  for (const line of lines) {
    const points = spaced(line.points, step);
    if (points.length < 2) continue;
    const colour = actionColour(line.action);
    parts.add(colour, tubeAlong(points, 0.014), null, (geometry) => new THREE.Mesh(
        geometry, new THREE.MeshBasicMaterial({color: colour, side: THREE.DoubleSide})));
  }
  return parts.group();
}
