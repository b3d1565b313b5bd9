'use strict';

/* Everything that is drawn: the world, the explored graph, the route and the robot. */

const kLimbColours = ['#d1495b', '#2667c9', '#e6a117', '#6a4c93', '#1b998b', '#8d5524'];
const kForceScale = 1 / 800;  // m per N
const kFieldOfView = 35;      // degrees
const kLift = 0.004;          // m, keeps flat marks out of the ground's face

/* Phases by the first word of their name; a swing has its limb's colour. */
const kPhaseColours = {
  preparation: '#aab3bf', crouch: '#5b8def', toes: '#f2b134', flight: '#e0219f',
  settle: '#8e6bd1', landing: '#20a39e', stance: '#ccd2da', on: '#98a2b0', swing: '#98a2b0'};

/* By action, from the page's data: one table serves pages and pictures. */
const actionColours = {};
const actionColour = (action) => actionColours[action];
const limbColour = (contact) => kLimbColours[contact % kLimbColours.length];

function phaseColour(phase, contacts) {
  const [kind, ...rest] = phase.name.split(' ');
  const limb = contacts.findIndex((contact) => contact.name === rest.join(' '));
  return kind === 'swing' && limb >= 0 ? limbColour(limb) : kPhaseColours[kind];
}

/* Geometries of a collision shape in its own frame. */
function shapeGeometries(shape) {
  const upright = (geometry) => geometry.rotateX(Math.PI / 2);
  switch (shape.type) {
    case 'box': return [new THREE.BoxBufferGeometry(...shape.size)];
    case 'sphere': return [new THREE.SphereBufferGeometry(shape.radius, 24, 16)];
    case 'cylinder':
      return [upright(
          new THREE.CylinderBufferGeometry(shape.radius, shape.radius, shape.length, 28))];
    case 'capsule': {
      const side = new THREE.CylinderBufferGeometry(
          shape.radius, shape.radius, shape.length, 24, 1, true);
      const ends = [-1, 1].map(
          (end) => new THREE.SphereBufferGeometry(shape.radius, 24, 14)
                       .translate(0, 0, end * shape.length / 2));
      return [upright(side), ...ends];
    }
    case 'convex':
      return [new THREE.ConvexBufferGeometry(
          shape.vertices.map((vertex) => new THREE.Vector3(...vertex)))];
  }
  throw new Error('unknown shape ' + shape.type);
}

/* Points of a patch in order around its centre, seen from above. */
function outline(points) {
  const centre = points.reduce((sum, p) => sum.add(p), new THREE.Vector3())
                     .divideScalar(points.length);
  const angle = (p) => Math.atan2(p.y - centre.y, p.x - centre.x);
  return points.slice().sort((a, b) => angle(a) - angle(b));
}

function lineMaterial(colour, opacity = 1) {
  return new THREE.LineBasicMaterial({color: colour, transparent: opacity < 1, opacity});
}

const isOutlined = (points) => points.length > 2;  // a sole; a peg is a dot

function fanOf(ring) {
  const fan = [];
  for (let i = 1; i + 1 < ring.length; ++i) fan.push(ring[0], ring[i], ring[i + 1]);
  return fan;
}

function dotAt(point) {
  const ring = Array.from({length: 20}, (_, i) => new THREE.Vector3(
      point.x + 0.025 * Math.cos(i * Math.PI / 10), point.y + 0.025 * Math.sin(i * Math.PI / 10),
      point.z));
  return fanOf(ring);
}

/* Adds a mark on the ground: a sole's outline and face, or dots. */
function addFootprint(parts, points, colour) {
  const face = (opacity) => (geometry) => new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(
      {color: colour, transparent: true, opacity, side: THREE.DoubleSide, depthWrite: false}));
  if (!isOutlined(points)) {
    for (const point of points) parts.addPoints('dot ' + colour, dotAt(point), face(0.9));
    return;
  }
  const ring = outline(points);
  const edges = [].concat(...ring.map((point, i) => [point, ring[(i + 1) % ring.length]]));
  parts.addPoints('edge ' + colour, edges,
                  (geometry) => new THREE.LineSegments(geometry, lineMaterial(colour)));
  parts.addPoints('face ' + colour, fanOf(ring), face(0.28));
}

/* The marks of touchdowns, {contact, points} each. */
function footprints(touchdowns) {
  const parts = new MergedParts();
  touchdowns.forEach(
      ({contact, points}) => addFootprint(parts, points, limbColour(contact)));
  const group = parts.group();
  group.position.z = kLift;
  return group;
}

/* One that closes the way is red. */
function addObstacle(parts, obstacle, closes) {
  const kind = closes ? 'closes' : obstacle.ground ? 'ground' : 'obstacle';
  const lines = {closes: '#8f1d1d', ground: '#aab1ba', obstacle: '#9a6a35'}[kind];
  const face = () => kind === 'ground' ? new THREE.MeshLambertMaterial({color: '#d0d3d8'})
      : new THREE.MeshLambertMaterial(
            {color: closes ? kBarrierColour : '#d9a066', transparent: true,
             opacity: closes ? 0.7 : 0.45, depthWrite: false});
  const place = poseMatrix(obstacle.pose);
  for (const geometry of shapeGeometries(obstacle.shape)) {
    parts.add(kind + ' edges', new THREE.EdgesGeometry(geometry, 30), place,
              (all) => new THREE.LineSegments(all, lineMaterial(lines, 0.8)));
    parts.add(kind + (geometry.index ? '' : ' convex'), geometry, place, (all) => {
      const mesh = new THREE.Mesh(all, face());
      mesh.receiveShadow = true;
      return mesh;
    });
  }
}

/* A mesh or height map, with its own colour where it is level enough to bear, and lines along its
   edges unless there are too many. Of ground that closes the way only the rest is red. */
const kBearingSlope = Math.cos(Math.PI / 4);
const kMostOutlined = 20000;  // triangles

function surfaceMesh(surface, closes) {
  const group = new THREE.Group();
  const indexed = new THREE.BufferGeometry();
  indexed.setAttribute(
      'position', new THREE.BufferAttribute(decodeFloats(surface.vertices), 3));
  const triangles = new Uint32Array(decodeIntegers(surface.triangles));
  indexed.setIndex(new THREE.BufferAttribute(triangles, 1));
  const geometry = indexed.toNonIndexed();  // so that every triangle has a normal of its own
  geometry.computeVertexNormals();
  const normals = geometry.attributes.normal;
  const bears = new THREE.Color('#d0d3d8'), steep = new THREE.Color('#b7aa9b');
  const other = closes ? new THREE.Color(kBarrierColour)
      : surface.ground ? steep : new THREE.Color('#d9a066');
  const colours = new Float32Array(3 * normals.count);
  for (let i = 0; i < normals.count; ++i) {
    const colour = surface.ground && normals.getZ(i) >= kBearingSlope - 1e-6 ? bears : other;
    colour.toArray(colours, 3 * i);
  }
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
  const isSolid = surface.ground;
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial(
      {vertexColors: THREE.VertexColors, side: THREE.DoubleSide, transparent: !isSolid,
       opacity: isSolid ? 1 : 0.6, depthWrite: isSolid}));
  mesh.receiveShadow = true;
  group.add(mesh);
  if (triangles.length <= 3 * kMostOutlined) {
    group.add(new THREE.LineSegments(
        new THREE.EdgesGeometry(indexed, 10),
        lineMaterial(closes ? '#8f1d1d' : surface.ground ? '#98a0aa' : '#9a6a35', 0.8)));
  }
  return group;
}

function addShapes(group, shapes, material) {
  for (const shape of shapes) {
    for (const geometry of shapeGeometries(shape)) {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.applyMatrix(poseMatrix(shape.pose));
      mesh.castShadow = !material.transparent;
      group.add(mesh);
    }
  }
}

/* One link. `meshes`: geometries of the page's meshes. Where it is known what the link looks like,
   its collision shapes are a part that can be switched on. */
function linkGroup(link, meshes) {
  const group = new THREE.Group();
  group.matrixAutoUpdate = false;
  const solid = new THREE.MeshPhongMaterial({color: '#8b99ab', shininess: 25});
  addShapes(group, (link.look || link.shapes).filter(({type}) => type !== 'mesh'), solid);
  if (!link.look) return group;
  for (const {mesh, pose} of link.look.filter(({type}) => type === 'mesh')) {
    const seen = new THREE.Mesh(meshes[mesh], solid);
    seen.applyMatrix(poseMatrix(pose));
    seen.castShadow = true;
    group.add(seen);
  }
  const collision = new THREE.Group();
  collision.name = 'collision';
  collision.visible = false;
  addShapes(collision, link.shapes, new THREE.MeshPhongMaterial(
      {color: '#d1495b', transparent: true, opacity: 0.35, depthWrite: false}));
  group.add(collision);
  return group;
}

function label(text, colour, size = 1) {
  const canvas = document.createElement('canvas');
  canvas.width = 256;
  canvas.height = 64;
  const context = canvas.getContext('2d');
  context.font = '600 34px system-ui, "DejaVu Sans", sans-serif';
  context.textAlign = 'center';
  context.fillStyle = colour;
  context.fillText(text, 128, 44);
  const map = new THREE.CanvasTexture(canvas);
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map, depthTest: false}));
  sprite.scale.set(0.8 * size, 0.2 * size, 1);
  return sprite;
}

/* A ring on the ground with an arrow along the heading. */
function stanceMarker(stance, text, colour, size) {
  const group = new THREE.Group();
  const material = new THREE.MeshBasicMaterial({color: colour, side: THREE.DoubleSide});
  group.add(new THREE.Mesh(new THREE.RingBufferGeometry(0.30, 0.34, 48), material));
  const tip = new THREE.Mesh(new THREE.CircleBufferGeometry(0.1, 3), material);
  tip.position.x = 0.42;
  group.add(tip);
  const name = label(text, colour, size);
  name.position.set(0, -0.42 - 0.09 * size, 0.05);
  group.add(name);
  group.position.set(stance.x, stance.y, stance.z + kLift);
  group.rotation.z = stance.yaw;
  return group;
}

function exploredGraph(explored) {
  const group = new THREE.Group();
  const xyz = decodeFloats(explored.vertices), edges = decodeIntegers(explored.edges);
  const vertex = (i) => [xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]];
  const addBuffer = (positions, make) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    group.add(make(geometry));
  };
  explored.actions.forEach((action, index) => {
    const ends = [];
    for (let e = 0; e < edges.length; e += 3) {
      if (edges[e + 2] === index) ends.push(...vertex(edges[e]), ...vertex(edges[e + 1]));
    }
    const colour = actionColour(action);
    addBuffer(ends, (g) => new THREE.LineSegments(g, lineMaterial(colour, 0.55)));
    addBuffer(ends, (g) => new THREE.Points(g, new THREE.PointsMaterial(
        {color: colour, size: 3, sizeAttenuation: false})));
  });
  return group;
}

/* Parts that are seen together or not at all; some may be missing. */
class Together {
  constructor(parts) { this.parts = parts.filter(Boolean); }
  set visible(on) { this.parts.forEach((part) => { part.visible = on; }); }
  get visible() { return this.parts.some((part) => part.visible); }
}

/* The browser offers no WebGL. */
class NoWebGl extends Error {}

function makeRenderer(canvas) {
  try {
    return new THREE.WebGLRenderer({canvas, antialias: true});
  } catch (error) {
    throw new NoWebGl(error.message);
  }
}

class Drawing {
  /* Throws NoWebGl. */
  constructor(canvas, data, motion) {
    this.motion = motion;
    this.renderer = makeRenderer(canvas);
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setClearColor('#f7f8fa');
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.05, 500);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;  // keys.js has them
    this.addLights();
    this.addWorld(data);
    this.addRobot(data);
    this.follow = false;
    this.stale = true;
    this.controls.addEventListener('change', () => { this.stale = true; });
  }

  addLights() {
    this.scene.add(new THREE.HemisphereLight('#ffffff', '#c3c7cd', 0.68));
    this.sun = new THREE.DirectionalLight('#ffffff', 0.38);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    Object.assign(this.sun.shadow.camera, {left: -2, right: 2, top: 2, bottom: -2, far: 12});
    this.scene.add(this.sun, this.sun.target);
  }

  addWorld(data) {
    const world = new THREE.Group();
    const closedBy = data.no && data.no.barrier ? data.no.barrier.closed_by : [];
    const parts = new MergedParts();
    data.obstacles.forEach((obstacle) => {
      addObstacle(parts, obstacle, closedBy.includes(obstacle.name));
    });
    world.add(parts.group());
    data.surfaces.forEach((surface) => {
      world.add(surfaceMesh(surface, closedBy.includes(surface.name)));
    });
    this.scene.add(world);
    const [x0, y0, x1, y1] = data.bounds;
    const size = Math.min(1, Math.max(0.55, Math.hypot(x1 - x0, y1 - y0) / 8));  // of words
    this.scene.add(stanceMarker(data.start, 'start', '#1d2530', size));
    data.goals.forEach((goal) => this.scene.add(stanceMarker(goal, 'goal', '#c2182b', size)));
    this.graph = exploredGraph(data.explored);
    this.route = routeTubes(this.motion);
    this.barrier = barrierGroup(data);
    this.scene.add(this.graph, this.route, this.barrier, flightArcs(this.motion));
    this.centre = new CentreOfMass(this.motion);
    this.com = this.centre.group;
    this.scene.add(this.com);
    this.footprints = footprints(this.motion.touchdowns());
    this.scene.add(this.footprints);
    this.bounds = new THREE.Box3(new THREE.Vector3(x0, y0, 0), new THREE.Vector3(x1, y1, 1.2));
  }

  addRobot(data) {
    const meshes = data.meshes.map(creasedGeometry);
    this.links = data.links.map((link) => linkGroup(link, meshes));
    this.links.forEach((link) => this.scene.add(link));
    this.collision = new Together(this.links.map((link) => link.getObjectByName('collision')));
    this.patches = data.contacts.map((contact, index) => {
      const parts = new MergedParts();
      addFootprint(parts, contact.points.map((p) => new THREE.Vector3(...p)), limbColour(index));
      const patch = parts.group();
      patch.traverse((part) => {
        if (part.material) {
          Object.assign(part.material, {depthTest: false, transparent: true, opacity: 0.85});
        }
      });
      patch.renderOrder = 1;
      this.links[contact.link].add(patch);
      return patch;
    });
    this.balanceMarks = new BalanceMarks(this.motion, data);
    this.balance = this.balanceMarks.group;
    if (this.motion.phases.length) this.scene.add(this.balance);
    this.forces = new THREE.Group();
    this.forces.visible = false;
    this.impulses = new THREE.Group();
    this.scene.add(this.forces, this.impulses);
    if (this.motion.phases.length) return;
    this.links.forEach((link) => { link.visible = false; });
    this.shineOn(this.bounds.getCenter(new THREE.Vector3()));
  }

  /* Moves the robot to where it is at time t. */
  update(t) {
    this.stale = true;
    if (!this.motion.phases.length) return;
    const phase = this.motion.phaseAt(t);
    this.motion.poseLinks(t, phase).forEach((pose, i) => {
      this.links[i].matrix.copy(pose);
      this.links[i].matrixWorldNeedsUpdate = true;
    });
    this.patches.forEach((patch, i) => { patch.visible = phase.contacts.includes(i); });
    this.updateForces(t, phase);
    this.updateImpulses(t, phase);
    this.centre.update(t, phase);
    this.balanceMarks.update(t, phase);
    const root = new THREE.Vector3().setFromMatrixPosition(this.motion.linkPoses[0]);
    this.shineOn(root);
    if (this.follow) this.moveTarget(root);
  }

  shineOn(point) {
    this.sun.position.copy(point).add(new THREE.Vector3(1.5, -2, 5));
    this.sun.target.position.copy(point);
  }

  updateForces(t, phase) {
    if (!this.forces.visible) return;
    this.forces.remove(...this.forces.children);
    const points = this.motion.bearingPoints(phase);
    this.motion.contactForces(t, phase).forEach((force, i) => {
      const length = force.length() * kForceScale;
      if (length < 1e-3) return;
      const arrow = new THREE.ArrowHelper(
          force.clone().normalize(), points[i], length, '#b5179e', 0.25 * length, 0.05);
      arrow.traverse((part) => {
        if (part.material) Object.assign(part.material, {depthTest: false, transparent: true});
        part.renderOrder = 2;
      });
      this.forces.add(arrow);
    });
  }

  /* An impact is over at once; it is shown for a moment, and fades. */
  updateImpulses(t, phase) {
    this.impulses.remove(...this.impulses.children);
    const age = (t - phase.begin) / kImpactShown;
    if (!this.forces.visible || age > 1) return;
    const points = this.motion.bearingPoints(phase);
    phase.impulses.forEach((impulse, i) => {
      if (impulse.length() * kImpulseScale < 1e-3) return;
      this.impulses.add(thickArrow(points[i], impulse, 1 - 0.8 * age));
    });
  }

  moveTarget(target) {
    this.camera.position.add(target).sub(this.controls.target);
    this.controls.target.copy(target);
    this.controls.update();
  }

  /* Diagonal of the world, m. */
  get size() { return this.bounds.getSize(new THREE.Vector3()).length(); }

  /* Looks at the robot if it is followed, otherwise at the whole world. */
  look(view) {
    const directions = {iso: [-0.62, -0.72, 0.6], top: [0, -1e-3, 1], side: [0, -1, 0.12]};
    const direction = new THREE.Vector3(...directions[view]).normalize();
    const target = this.bounds.getCenter(new THREE.Vector3());
    let distance = 4;
    if (this.follow && this.motion.phases.length) {
      target.setFromMatrixPosition(this.motion.linkPoses[0]);
    } else {
      distance = this.distanceToSee(direction, target);
    }
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.update();
    this.stale = true;
  }

  /* Turns the eye about what it looks at, rad: about the vertical, and up. */
  turn(about, over) {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const upright = new THREE.Quaternion().setFromUnitVectors(
        this.camera.up, new THREE.Vector3(0, 1, 0));
    const sphere = new THREE.Spherical().setFromVector3(arm.applyQuaternion(upright));
    sphere.theta += about;
    sphere.phi -= over;
    arm.setFromSpherical(sphere.makeSafe()).applyQuaternion(upright.inverse());
    this.camera.position.copy(this.controls.target).add(arm);
    this.controls.update();
    this.stale = true;
  }

  /* Makes the eye's distance `factor` times as long. */
  approach(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.stale = true;
  }

  /* The eye, and the place it looks at: six coordinates. */
  place() {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }
  lookFrom(place) {
    this.camera.position.fromArray(place, 0);
    this.controls.target.fromArray(place, 3);
    this.controls.update();
    this.stale = true;
  }

  /* Looks at its world as another drawing looks at its own; each follows its own robot. */
  lookLike(other) {
    const shift = this.bounds.getCenter(new THREE.Vector3())
                      .sub(other.bounds.getCenter(new THREE.Vector3()));
    const target = this.follow ? this.controls.target.clone()
                               : other.controls.target.clone().add(shift);
    this.camera.position.copy(other.camera.position).sub(other.controls.target).add(target);
    this.controls.target.copy(target);
    this.controls.update();
    this.stale = true;
  }

  /* Least distance from which every corner of the world is in view. */
  distanceToSee(direction, target) {
    const up = new THREE.Vector3(0, 0, 1);
    const right = new THREE.Vector3().crossVectors(up, direction).normalize();
    const above = new THREE.Vector3().crossVectors(direction, right);
    const vertical = Math.tan(kFieldOfView * Math.PI / 360);
    const horizontal = vertical * this.camera.aspect;
    let distance = 1;
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(
          i & 1 ? this.bounds.max.x : this.bounds.min.x,
          i & 2 ? this.bounds.max.y : this.bounds.min.y,
          i & 4 ? this.bounds.max.z : this.bounds.min.z).sub(target);
      distance = Math.max(
          distance, corner.dot(direction) + Math.max(Math.abs(corner.dot(right)) / horizontal,
                                                     Math.abs(corner.dot(above)) / vertical));
    }
    return 1.06 * distance;
  }

  resize(width, height) {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.stale = true;
  }

  render() {
    if (!this.stale) return;
    this.stale = false;
    this.renderer.render(this.scene, this.camera);
  }
}
