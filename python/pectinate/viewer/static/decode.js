// The other half of pectinate/viewer/encoding.py: from text to typed arrays.

const NO_VALUE = 65535;

async function inflate(text) {
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// One array as it was before it was taken apart: rows one after the other.
function unpack(bytes, place) {
  const { start, rows, columns, differences } = place;
  const wide = place.bytes === 4;
  const result = wide ? new Uint32Array(rows * columns) : new Uint16Array(rows * columns);
  for (let column = 0; column < columns; column++) {
    const sums = new Array(differences).fill(0);
    const first = start + column * rows * place.bytes;
    for (let row = 0; row < rows; row++) {
      let value = 0;
      for (let plane = place.bytes - 1; plane >= 0; plane--) value = (value << 8) | bytes[first + plane * rows + row];
      if (differences > 0) value = (value >>> 1) ^ -(value & 1);
      for (let order = 0; order < differences; order++) value = sums[order] = (sums[order] + value) | 0;
      result[row * columns + column] = value;  // wraps around
    }
  }
  return result;
}

function unpackPoints(bytes, lines) {
  const steps = unpack(bytes, lines.positions);
  return Float32Array.from(steps, (step, index) => lines.origin[index % 3] + lines.step * step);
}

// Unit vectors in 127ths.
function unpackDirections(bytes, place) {
  return Float32Array.from(new Int16Array(unpack(bytes, place).buffer), (step) => step / 127);
}

// Corners of triangles: 0 stands for a vertex that no triangle before has used.
function unpackTriangles(bytes, place) {
  const corners = unpack(bytes, place);
  let seen = 0;
  for (let i = 0; i < corners.length; i++) corners[i] = corners[i] === 0 ? seen++ : seen - corners[i];
  return corners;
}
