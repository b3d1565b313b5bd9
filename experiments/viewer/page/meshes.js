'use strict';

/* Meshes of the robot: round where its surface is round, with an edge where it has one. */

const kCrease = Math.cos(Math.PI / 5);  // between normals of triangles

/* Normals of triangles, as long as twice their area; and their directions. */
function triangleNormals(vertices, triangles) {
  const corner = (i) => new THREE.Vector3().fromArray(vertices, 3 * triangles[i]);
  const normals = [], directions = [];
  for (let i = 0; i < triangles.length; i += 3) {
    const a = corner(i);
    const normal = corner(i + 1).sub(a).cross(corner(i + 2).sub(a));
    normals.push(normal);
    directions.push(normal.clone().normalize());
  }
  return {normals, directions};
}

function trianglesAtVertices(triangles, count) {
  const around = Array.from({length: count}, () => []);
  triangles.forEach((vertex, i) => { around[vertex].push(Math.floor(i / 3)); });
  return around;
}

/* The geometry of a mesh as the page has it. A corner's normal is the mean of those of the
   triangles about it that its own one meets without a crease. */
function creasedGeometry(mesh) {
  const vertices = decodeFloats(mesh.vertices), triangles = decodeIntegers(mesh.triangles);
  const {normals, directions} = triangleNormals(vertices, triangles);
  const around = trianglesAtVertices(triangles, vertices.length / 3);
  const positions = new Float32Array(3 * triangles.length), shading = positions.slice();
  triangles.forEach((vertex, i) => {
    const own = directions[Math.floor(i / 3)], mean = new THREE.Vector3();
    for (const other of around[vertex]) {
      if (own.dot(directions[other]) >= kCrease) mean.add(normals[other]);
    }
    positions.set(vertices.subarray(3 * vertex, 3 * vertex + 3), 3 * i);
    mean.normalize().toArray(shading, 3 * i);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(shading, 3));
  return geometry;
}
