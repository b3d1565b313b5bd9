'use strict';

/* What lies between the start and the goals where there is no plan: the regions that were reached,
   the point closest to a goal, and the shapes that close the way on. */

const kBarrierColour = '#e03131';
const kPelvisColour = '#7a8699';  // of what the pelvis alone reaches

const regionColour = (action) => action ? actionColour(action) : kPelvisColour;

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
  const colour = regionColour(region.action);
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

/* A ring about the point closest to a goal, and a dashed line to that goal. */
function closestMark(barrier, goals, size) {
  const group = new THREE.Group();
  const [x, y] = barrier.closest;
  const away = (goal) => Math.hypot(goal.x - x, goal.y - y);
  const goal = goals.reduce((best, next) => away(next) < away(best) ? next : best);
  const material = new THREE.MeshBasicMaterial(
      {color: kBarrierColour, side: THREE.DoubleSide, depthTest: false, transparent: true});
  const ring = new THREE.Mesh(new THREE.RingBufferGeometry(0.11, 0.16, 40), material);
  ring.position.set(x, y, goal.z + 2 * kLift);
  const line = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints(
          [new THREE.Vector3(x, y, goal.z + 2 * kLift),
           new THREE.Vector3(goal.x, goal.y, goal.z + 2 * kLift)]),
      new THREE.LineDashedMaterial({color: kBarrierColour, dashSize: 0.12, gapSize: 0.08}));
  line.computeLineDistances();
  const name = label('closest', kBarrierColour, size);
  name.position.set(x, y - 0.2 - 0.09 * size, goal.z + 0.05);
  group.add(ring, line, name);
  group.children.forEach((part) => { part.renderOrder = 3; });
  return group;
}

function barrierGroup(data) {
  const group = new THREE.Group();
  if (!data.no || !data.no.barrier) return group;
  const [x0, y0, x1, y1] = data.bounds;
  const size = Math.min(1, Math.max(0.55, Math.hypot(x1 - x0, y1 - y0) / 8));  // of words
  const {barrier} = data.no;
  barrier.reached.forEach((region, i) => group.add(regionMesh(region, (i + 1) * kLift)));
  if (data.goals.length) group.add(closestMark(barrier, data.goals, size));
  return group;
}
