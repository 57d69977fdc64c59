// Where the page looks: a rotation from scene to picture, the middle of the picture and its scale.

class View {
  constructor() {
    this.rotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];  // rows: right, up, towards the viewer
    this.centre = [0, 0, 0];
    this.mmPerPixel = 1;
  }

  // Look as a standard view does, at all of some clouds of points (flat coordinates), in a picture of a size in pixels of
  // which some at the left and at the right are taken.
  frame(rotation, clouds, [width, height], [left, right], margin) {
    this.rotation = rotation;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const points of clouds) {
      for (let i = 0; i < points.length; i += 3) {
        for (let axis = 0; axis < 3; axis++) {
          const [x, y, z] = rotation[axis];
          const seen = x * points[i] + y * points[i + 1] + z * points[i + 2];
          if (seen < low[axis]) low[axis] = seen;
          if (seen > high[axis]) high[axis] = seen;
        }
      }
    }
    if (!(low[0] <= high[0])) return;
    this.centre = this.toScene(low.map((x, axis) => 0.5 * (x + high[axis])));
    const scales = [width - left - right, height]
      .map((pixels, axis) => (high[axis] - low[axis]) / (pixels * (1 - 2 * margin)));
    this.mmPerPixel = Math.max(...scales) || 1;
    this.move(0.5 * (left - right), 0);
  }

  toScene(seen) {
    return [0, 1, 2].map((axis) => dot(seen, this.rotation.map((row) => row[axis])));
  }

  // Pixels from the middle of the picture, y upwards, and mm towards the viewer.
  toPicture(point) {
    const [x, y, z] = this.rotation.map((row) => dot(row, minus(point, this.centre)));
    return [x / this.mmPerPixel, y / this.mmPerPixel, z];
  }

  // Turn as a ball of a radius does under a pointer that moves by (dx, dy) pixels, y upwards.
  turn(dx, dy, radius) {
    const distance = Math.hypot(dx, dy);
    if (distance === 0) return;
    this.turnAbout([-dy / distance, dx / distance, 0], distance / radius);
  }

  // Turn about an axis in picture coordinates.
  turnAbout(axis, angle) {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const turned = (v) => {
      const w = cross(axis, v), along = dot(axis, v) * (1 - c);
      return v.map((x, k) => c * x + s * w[k] + along * axis[k]);
    };
    const columns = [0, 1, 2].map((k) => turned(this.rotation.map((row) => row[k])));
    const rows = [0, 1, 2].map((k) => columns.map((column) => column[k]));
    const right = unit(rows[0]), towards = unit(cross(right, rows[1]));
    this.rotation = [right, cross(towards, right), towards];
  }

  move(dx, dy) {
    const shift = this.toScene([dx * this.mmPerPixel, dy * this.mmPerPixel, 0]);
    this.centre = minus(this.centre, shift);
  }

  // Zoom so that what is at (x, y) pixels from the middle stays there.
  zoom(factor, x, y) {
    this.move(-x, -y);
    this.mmPerPixel = Math.min(Math.max(this.mmPerPixel / factor, 1e-6), 1e6);
    this.move(x, y);
  }
}
