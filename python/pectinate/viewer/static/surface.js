// The surface of a part: its triangles, and the colours of its values.

function buildSurface(bytes, description) {
  const positions = unpackPoints(bytes, description);
  const corners = unpackTriangles(bytes, description.triangles);
  return { positions, corners, normals: vertexNormals(positions, corners) };
}

// The mean of the triangles' normals, weighted by area; the shader makes them unit vectors.
function vertexNormals(positions, corners) {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [3 * corners[i], 3 * corners[i + 1], 3 * corners[i + 2]];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2], vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (const vertex of [a, b, c]) {
      normals[vertex] += x;
      normals[vertex + 1] += y;
      normals[vertex + 2] += z;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let axis = 0; axis < 3; axis++) normals[i + axis] /= length;
  }
  return normals;
}

function plainGeometry(surface) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(surface.corners, 1));
  geometry.setAttribute('position', new THREE.BufferAttribute(surface.positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(surface.normals, 3));
  return geometry;
}

// Each triangle with corners of its own, whose colours it does not share with its neighbours.
function coloredGeometry(surface, values, steps, scale, missing) {
  const { corners } = surface;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', perCorner(surface.positions, corners));
  geometry.setAttribute('normal', perCorner(surface.normals, corners));
  const colors = new Uint8Array(3 * corners.length);
  const atCorner = (i) => steps[values.per_triangle ? Math.floor(i / 3) : corners[i]];
  for (let i = 0; i < corners.length; i++) {
    const first = i - (i % 3);
    const known = ![0, 1, 2].some((k) => atCorner(first + k) === NO_VALUE);
    const entry = known ? 3 * Math.min(255, Math.floor((256 * atCorner(i)) / (NO_VALUE - 1))) : 0;
    for (let k = 0; k < 3; k++) colors[3 * i + k] = known ? scale.bytes[entry + k] : 255 * missing[k];
  }
  geometry.setAttribute('valueColor', new THREE.BufferAttribute(colors, 3, true));
  return geometry;
}

function perCorner(table, corners) {
  const result = new Float32Array(3 * corners.length);
  for (let i = 0; i < corners.length; i++) {
    for (let axis = 0; axis < 3; axis++) result[3 * i + axis] = table[3 * corners[i] + axis];
  }
  return new THREE.BufferAttribute(result, 3);
}
