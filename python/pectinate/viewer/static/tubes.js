// Tubes around lines. A vertex is its centre, a unit vector away from it, a thickness and the direction in which flat
// tubes are low; the shader multiplies by the radius, so that a slider can change it.

const SIDE_COUNT = 8;
// Where the rings of a round end lie, as shares of a quarter turn.
const END_RINGS = [1, 2 / 3, 1 / 3, 0];

function buildTubes(bytes, description) {
  const points = unpackPoints(bytes, description);
  const counts = unpack(bytes, description.counts);
  const normals = description.normals ? unpackDirections(bytes, description.normals) : new Float32Array(points.length);
  const round = description.taper_length === 0;
  const extraRings = round ? 2 * (END_RINGS.length - 1) : 0;
  const closed = new Set(description.closed);
  const openCount = counts.length - closed.size;
  const rings = new Rings(points.length / 3 + extraRings * openCount - closed.size);
  let first = 0;
  counts.forEach((count, line) => {
    const add = closed.has(line) ? addClosedTube : addTube;
    const here = [3 * first, 3 * (first + count)];
    add(rings, points.subarray(...here), normals.subarray(...here), description.taper_length, first);
    first += count;
  });
  const geometry = rings.geometry();
  geometry.userData.height = description.height;
  return geometry;
}

// Rings of vertices, one after the other, each joined to the one before unless it begins a tube.
class Rings {
  constructor(count) {
    this.centres = new Float32Array(3 * count * SIDE_COUNT);
    this.offsets = new Int8Array(4 * count * SIDE_COUNT);
    this.ups = new Int8Array(4 * count * SIDE_COUNT);
    this.thicknesses = new Float32Array(count * SIDE_COUNT);
    this.points = new Uint32Array(count);
    this.corners = new Uint32Array(6 * count * SIDE_COUNT);
    this.vertexCount = this.cornerCount = 0;
  }

  // `lean` is the angle of the offsets towards the tangent: not 0 at round ends only. `index` is that of the point.
  add(centre, frame, thickness, lean, begins, index) {
    const start = this.vertexCount;
    this.points[start / SIDE_COUNT] = index;
    const [across, along] = [Math.cos(lean), Math.sin(lean)];
    for (let side = 0; side < SIDE_COUNT; side++) {
      const angle = (2 * Math.PI * side) / SIDE_COUNT;
      const [c, s] = [across * Math.cos(angle), across * Math.sin(angle)];
      for (let axis = 0; axis < 3; axis++) {
        const offset = c * frame.side[axis] + s * frame.other[axis] + along * frame.tangent[axis];
        this.centres[3 * this.vertexCount + axis] = centre[axis];
        this.offsets[4 * this.vertexCount + axis] = Math.round(127 * offset);
        this.ups[4 * this.vertexCount + axis] = Math.round(127 * frame.up[axis]);
      }
      this.thicknesses[this.vertexCount++] = thickness;
    }
    if (!begins) this.join(start - SIDE_COUNT, start);
  }

  join(ring, next) {
    for (let k = 0; k < SIDE_COUNT; k++) {
      const l = (k + 1) % SIDE_COUNT;
      this.corners.set([ring + k, ring + l, next + k, ring + l, next + l, next + k], this.cornerCount);
      this.cornerCount += 6;
    }
  }

  geometry() {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(this.corners.subarray(0, this.cornerCount), 1));
    geometry.setAttribute('position', new THREE.BufferAttribute(this.centres, 3));
    geometry.setAttribute('offset', new THREE.BufferAttribute(this.offsets, 4, true));
    geometry.setAttribute('up', new THREE.BufferAttribute(this.ups, 4, true));
    geometry.setAttribute('thickness', new THREE.BufferAttribute(this.thicknesses, 1));
    geometry.userData.points = this.points;
    return geometry;
  }
}

// Where the vertices are with a radius, as the shader has them, in flat coordinates.
function tubeSurface(geometry, radius) {
  const [centres, offsets, ups, shares] = ['position', 'offset', 'up', 'thickness'].map((name) => geometry.attributes[name].array);
  const result = new Float32Array(centres.length);
  for (let i = 0; i < shares.length; i++) {
    let raised = 0;
    for (let axis = 0; axis < 3; axis++) raised += offsets[4 * i + axis] * ups[4 * i + axis];
    const lowered = ((1 - geometry.userData.height) * raised) / 127 ** 2;
    const scale = (radius * shares[i]) / 127;
    for (let axis = 0; axis < 3; axis++) {
      result[3 * i + axis] = centres[3 * i + axis] + scale * (offsets[4 * i + axis] - lowered * ups[4 * i + axis]);
    }
  }
  return result;
}

function addTube(rings, points, normals, taperLength, first) {
  const count = points.length / 3;
  const point = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
  const normal = (i) => [normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]];
  const arcs = [0];
  for (let i = 1; i < count; i++) arcs.push(arcs[i - 1] + length(minus(point(i), point(i - 1))));
  const total = arcs[count - 1];
  const rise = (arc) => -Math.expm1(-arc / taperLength);
  let side = null;
  for (let i = 0; i < count; i++) {
    const tangent = tangentAt(point, i, count);
    side = acrossTo(tangent, side);
    const up = unit(withoutPart(normal(i), tangent));
    const frame = { tangent, side, other: cross(tangent, side), up };
    if (taperLength > 0) {
      // Equation (3) of the paper.
      rings.add(point(i), frame, rise(arcs[i]) * rise(total - arcs[i]), 0, i === 0, first + i);
    } else {
      for (const lean of leans(i, count)) {
        rings.add(point(i), frame, 1, lean, i === 0 && lean === -0.5 * Math.PI, first + i);
      }
    }
  }
}

// Of a line whose last point is its first: as thick everywhere, without ends.
function addClosedTube(rings, points, normals, taperLength, first) {
  const count = points.length / 3 - 1;
  const at = (all, i) => [all[3 * (i % count)], all[3 * (i % count) + 1], all[3 * (i % count) + 2]];
  const point = (i) => at(points, i);
  const arcs = [0];
  for (let i = 1; i <= count; i++) arcs.push(arcs[i - 1] + length(minus(point(i), point(i - 1))));
  const tangents = arcs.map((_, i) => bisector(point(i + count - 1), point(i), point(i + 1)));
  const sides = [];
  for (let i = 0; i <= count; i++) sides.push(acrossTo(tangents[i], i > 0 ? sides[i - 1] : null));
  // Once round, the sides are turned against the first: each takes its share of that.
  const twist = Math.atan2(dot(cross(sides[count], sides[0]), tangents[0]), dot(sides[count], sides[0]));
  const start = rings.vertexCount;
  for (let i = 0; i < count; i++) {
    const angle = (twist * arcs[i]) / (arcs[count] || 1);
    const beside = cross(tangents[i], sides[i]);
    const side = sides[i].map((x, axis) => Math.cos(angle) * x + Math.sin(angle) * beside[axis]);
    const up = unit(withoutPart(at(normals, i), tangents[i]));
    rings.add(point(i), { tangent: tangents[i], side, other: cross(tangents[i], side), up }, 1, 0, i === 0, first + i);
  }
  rings.join(rings.vertexCount - SIDE_COUNT, start);
}

// Colours of the vertices, from steps of values at the points of the lines.
function colorTubes(geometry, steps, scale, missing) {
  const { points } = geometry.userData;
  const colors = new Uint8Array(3 * SIDE_COUNT * points.length);
  for (let ring = 0; ring < points.length; ring++) {
    const color = colorOf(steps[points[ring]], scale, missing);
    for (let side = 0; side < SIDE_COUNT; side++) colors.set(color, 3 * (SIDE_COUNT * ring + side));
  }
  geometry.setAttribute('valueColor', new THREE.BufferAttribute(colors, 3, true));
}

function leans(i, count) {
  const quarter = END_RINGS.map((share) => 0.5 * Math.PI * share);
  if (i === 0) return quarter.map((lean) => -lean);
  return i === count - 1 ? quarter.reverse() : [0];
}

function tangentAt(point, i, count) {
  return bisector(point(Math.max(i - 1, 0)), point(i), point(Math.min(i + 1, count - 1)));
}

function bisector(before, here, after) {
  const arriving = unit(minus(here, before));
  const leaving = unit(minus(after, here));
  const sum = arriving.map((x, axis) => x + leaving[axis]);
  // A line that goes back the way it came has no direction between both.
  if (length(sum) > 1e-6) return unit(sum);
  return length(leaving) > 0 ? leaving : [1, 0, 0];
}

// A unit vector across the tangent, turned as little as can be from the one before.
function acrossTo(tangent, previous) {
  const turned = previous ? withoutPart(previous, tangent) : [0, 0, 0];
  if (length(turned) > 1e-6) return unit(turned);
  const least = tangent.map(Math.abs).reduce((best, x, axis, all) => (x < all[best] ? axis : best), 0);
  return unit(withoutPart([0, 1, 2].map((axis) => (axis === least ? 1 : 0)), tangent));
}

// A vector without its part along a unit vector.
function withoutPart(vector, direction) {
  const along = dot(vector, direction);
  return vector.map((x, axis) => x - along * direction[axis]);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => {
  const norm = length(a) || 1;
  return [a[0] / norm, a[1] / norm, a[2] / norm];
};
