'use strict';

/* What lies between the start and the goals where there is no plan: the regions that were reached,
   the point closest to a goal, the narrowest place on the way, and the shapes that close it. */

const kBarrierColour = '#e03131';
const kPassageColour = '#b45309';

function signedArea(corners) {
  let area = 0;
  corners.forEach(([x, y], i) => {
    const [nextX, nextY] = corners[(i + 1) % corners.length];
    area += x * nextY - nextX * y;
  });
  return area / 2;
}

function isInside([x, y], corners) {
  let inside = false;
  corners.forEach(([x0, y0], i) => {
    const [x1, y1] = corners[(i + 1) % corners.length];
    if ((y0 > y) !== (y1 > y) && x < x0 + (y - y0) / (y1 - y0) * (x1 - x0)) inside = !inside;
  });
  return inside;
}

/* Parts with their holes: a hole belongs to the smallest part around it. */
function regionShapes(outlines) {
  const vectors = (corners) => corners.map(([x, y]) => new THREE.Vector2(x, y));
  const parts = outlines.filter((corners) => signedArea(corners) > 0)
                    .map((corners) => ({corners, shape: new THREE.Shape(vectors(corners))}))
                    .sort((a, b) => signedArea(a.corners) - signedArea(b.corners));
  for (const hole of outlines.filter((corners) => signedArea(corners) < 0)) {
    const middle = [(hole[0][0] + hole[1][0]) / 2, (hole[0][1] + hole[1][1]) / 2];
    const around = parts.find(({corners}) => isInside(middle, corners));
    if (around) around.shape.holes.push(new THREE.Path(vectors(hole)));
  }
  return parts.map(({shape}) => shape);
}

function regionMesh(region, lift) {
  const group = new THREE.Group();
  const colour = actionColour(region.action);
  const face = new THREE.MeshBasicMaterial(
      {color: colour, transparent: true, opacity: 0.22, side: THREE.DoubleSide, depthWrite: false});
  group.add(new THREE.Mesh(new THREE.ShapeBufferGeometry(regionShapes(region.outlines)), face));
  for (const corners of region.outlines) {
    const points = corners.map(([x, y]) => new THREE.Vector3(x, y, 0));
    group.add(new THREE.LineLoop(
        new THREE.BufferGeometry().setFromPoints(points), lineMaterial(colour, 0.9)));
  }
  group.position.z = region.z + lift;
  return group;
}

/* A ring on the ground that is seen through everything, and words on a side of it (1: above). */
function ringMark([x, y], z, words, side, colour, size) {
  const group = new THREE.Group();
  const material = new THREE.MeshBasicMaterial(
      {color: colour, side: THREE.DoubleSide, depthTest: false, transparent: true});
  const ring = new THREE.Mesh(new THREE.RingBufferGeometry(0.11, 0.16, 40), material);
  ring.position.set(x, y, z + 2 * kLift);
  const name = label(words, colour, size);
  name.position.set(x, y + side * (0.2 + 0.09 * size), z + 0.05);
  group.add(ring, name);
  group.children.forEach((part) => { part.renderOrder = 3; });
  return group;
}

/* The narrowest place on the way: what there is of what an action needs. */
function passageMark(passage, z, size) {
  const missing = ({available, needed}) => needed - available;
  const need = passage.needs.slice().sort((a, b) => missing(a) - missing(b))[0];
  const words = need ? `${need.available.toFixed(2)} of ${need.needed.toFixed(2)} m` : 'narrow';
  return ringMark(passage.place, z, words, 1, kPassageColour, size);
}

/* A ring about the point closest to a goal, and a dashed line to that goal. */
function closestMark(barrier, goals, size) {
  const [x, y] = barrier.closest;
  const away = (goal) => Math.hypot(goal.x - x, goal.y - y);
  const goal = goals.reduce((best, next) => away(next) < away(best) ? next : best);
  const group = ringMark(barrier.closest, goal.z, 'closest', -1, kBarrierColour, size);
  const line = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints(
          [new THREE.Vector3(x, y, goal.z + 2 * kLift),
           new THREE.Vector3(goal.x, goal.y, goal.z + 2 * kLift)]),
      new THREE.LineDashedMaterial({color: kBarrierColour, dashSize: 0.12, gapSize: 0.08}));
  line.computeLineDistances();
  line.renderOrder = 3;
  group.add(line);
  return group;
}

function addBarrier(barrier, goals, size, group) {
  barrier.reached.forEach((region, i) => group.add(regionMesh(region, (i + 1) * kLift)));
  if (goals.length) group.add(closestMark(barrier, goals, size));
}

function barrierGroup(data) {
  const group = new THREE.Group();
  if (!data.no) return group;
  const [x0, y0, x1, y1] = data.bounds;
  const size = Math.min(1, Math.max(0.55, Math.hypot(x1 - x0, y1 - y0) / 8));  // of words
  const {barrier, passage} = data.no;
  if (passage) group.add(passageMark(passage, data.start.z, size));
  if (barrier) addBarrier(barrier, data.goals, size, group);
  return group;
}
