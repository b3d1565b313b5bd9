'use strict';

/* Many small things as one: the graphics card draws one list of triangles or lines at once, but a
   thousand meshes one after the other. */

class MergedParts {
  constructor() {
    this.parts = new Map();
  }

  /* Adds a geometry at a place (Matrix4, or null) to the mesh or lines called `key`; make(geometry)
     gives their object. Those of one key all have an index, or none. */
  add(key, geometry, place, make) {
    if (place) geometry.applyMatrix(place);
    if (!this.parts.has(key)) this.parts.set(key, {make, pieces: []});
    this.parts.get(key).pieces.push(geometry);
  }

  /* A list of points for triangles or lines. */
  addPoints(key, points, make) {
    this.add(key, new THREE.BufferGeometry().setFromPoints(points), null, make);
  }

  /* A group of the objects, in the order in which their keys came. */
  group() {
    const group = new THREE.Group();
    this.parts.forEach(({make, pieces}) => group.add(make(merged(pieces))));
    return group;
  }
}

function joined(arrays, Type) {
  const all = new Type(arrays.reduce((sum, array) => sum + array.length, 0));
  let next = 0;
  for (const array of arrays) {
    all.set(array, next);
    next += array.length;
  }
  return all;
}

function merged(pieces) {
  const geometry = new THREE.BufferGeometry();
  for (const name of ['position', 'normal']) {
    if (!pieces.every((piece) => piece.attributes[name])) continue;
    const numbers = joined(pieces.map((piece) => piece.attributes[name].array), Float32Array);
    geometry.setAttribute(name, new THREE.BufferAttribute(numbers, 3));
  }
  if (!pieces[0].index) return geometry;
  let before = 0;
  const indices = pieces.map((piece) => {
    const first = before;
    before += piece.attributes.position.count;
    return Uint32Array.from(piece.index.array, (index) => index + first);
  });
  geometry.setIndex(new THREE.BufferAttribute(joined(indices, Uint32Array), 1));
  return geometry;
}
