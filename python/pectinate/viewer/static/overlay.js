// What is written over the scene: markers, the colour bar and the scale bar.

const LETTERS = 13;
const BAR_WIDTH = 14;
const ROUND_NUMBERS = [1, 2, 5];
const LONGEST_BAR = 0.28;

class Overlay {
  constructor(scene) {
    this.ink = cssColor(scene.style.ink_color);
    this.paper = cssColor(scene.style.background_color);
    this.noValue = cssColor(scene.style.no_value_color);
  }

  // `size` in CSS pixels; the context is scaled to them.
  draw(context, size, { view, markers, scale, someMissing }) {
    context.font = `${LETTERS}px system-ui, sans-serif`;
    context.lineWidth = 1.2;
    context.textBaseline = 'middle';
    for (const { place, text } of markers) this.marker(context, size, place, text);
    this.scaleBar(context, size, view.mmPerPixel);
    if (scale) this.colorBar(context, size, scale, someMissing);
  }

  marker(context, [width, height], [x, y], text) {
    const across = Math.max(context.measureText(text).width + 10, LETTERS + 9);
    const [left, top] = [0.5 * width + x - 0.5 * across, 0.5 * height - y - 0.5 * (LETTERS + 9)];
    context.beginPath();
    context.roundRect(left, top, across, LETTERS + 9, 0.5 * (LETTERS + 9));
    context.fillStyle = this.paper;
    context.fill();
    context.strokeStyle = context.fillStyle = this.ink;
    context.stroke();
    context.textAlign = 'center';
    context.fillText(text, 0.5 * width + x, 0.5 * height - y + 1);
  }

  scaleBar(context, [width, height], mmPerPixel) {
    const longest = LONGEST_BAR * Math.min(width, 700) * mmPerPixel;
    const power = 10 ** Math.floor(Math.log10(longest));
    const mm = Math.max(...ROUND_NUMBERS.map((factor) => factor * power).filter((long) => long <= longest), power);
    const pixels = mm / mmPerPixel;
    context.fillStyle = this.paper;
    context.fillRect(14, height - 22, pixels + 4, 7);
    context.fillStyle = this.ink;
    context.fillRect(16, height - 20, pixels, 3);
    context.textAlign = 'center';
    this.write(context, `${Number(mm.toPrecision(1))} mm`, 16 + 0.5 * pixels, height - 31);
  }

  colorBar(context, [, height], scale, someMissing) {
    const rows = Math.round(Math.min(0.5 * height, 320)), top = Math.round(0.5 * (height - rows)), left = 16;
    for (let row = 0; row < rows; row++) {
      const entry = 3 * Math.floor((256 * (rows - 1 - row + 0.5)) / rows);
      context.fillStyle = `rgb(${scale.bytes.subarray(entry, entry + 3).join()})`;
      context.fillRect(left, top + row, BAR_WIDTH, 1);
    }
    context.fillStyle = context.strokeStyle = this.ink;
    context.textAlign = 'left';
    for (const tick of scale.ticks) {
      const y = top + rows - ((tick - scale.low) / (scale.high - scale.low)) * rows;
      context.fillRect(left + BAR_WIDTH, y - 0.5, 4, 1);
      this.write(context, String(Number(tick.toPrecision(6))), left + BAR_WIDTH + 8, y);
    }
    this.write(context, scale.label, left, top - 16);
    if (!someMissing) return;
    context.fillStyle = this.noValue;
    context.fillRect(left, top + rows + 10, BAR_WIDTH, BAR_WIDTH);
    context.fillStyle = this.ink;
    this.write(context, 'none', left + BAR_WIDTH + 8, top + rows + 10 + 0.5 * BAR_WIDTH);
  }

  // Ink with a rim of paper, so that it can be read on the surface too.
  write(context, text, x, y) {
    context.lineJoin = 'round';
    context.lineWidth = 4;
    context.strokeStyle = this.paper;
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
  }
}

function cssColor(color) {
  return `rgb(${color.map((channel) => Math.round(255 * channel)).join()})`;
}
