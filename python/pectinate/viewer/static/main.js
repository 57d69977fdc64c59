// Puts the page together.

const COLOR_BAR_ROOM = 90;
const FOLDED_WIDTH = 60;
const LARGEST_INSET = 0.35;
const FINE_RATIO = 2;
const FINE_DELAY = 250;  // ms

const screenRatio = () => window.devicePixelRatio || 1;

class Viewer {
  constructor(scene, bytes, canvas, overlayCanvas, context) {
    this.scene = scene;
    this.canvas = canvas;
    this.overlayCanvas = overlayCanvas;
    this.picture = new Picture(canvas, scene, context);
    this.overlay = new Overlay(scene);
    this.view = new View();
    this.layers = { surface: true, contours: true, streamlines: true, tracts: true, markers: true };
    this.shownValues = this.shownTubeValues = -1;
    this.frameRequest = 0;
    for (const scale of [...scene.scales, ...scene.tube_scales]) scale.bytes = Uint8Array.from(atob(scale.colors), (c) => c.charCodeAt(0));
    this.parts = scene.parts.map((part) => this.buildPart(part, bytes));
  }

  buildPart(part, bytes) {
    const { style } = this.scene;
    const surface = buildSurface(bytes, part.surface);
    const clouds = [surface.positions];
    const tubes = (lines, color) => {
      if (!lines) return null;
      const geometry = buildTubes(bytes, lines);
      clouds.push(tubeSurface(geometry, lines.radius));
      return this.picture.addTubes(geometry, color, style.tube_gloss, lines.radius);
    };
    const plain = plainGeometry(surface);
    const withSteps = (values) => ({ ...values, steps: unpack(bytes, values.steps) });
    return {
      name: part.name,
      visible: part.visible,
      surface,
      clouds,
      plain,
      colored: null,
      values: part.values.map(withSteps),
      tubeValues: part.streamlines ? part.streamlines.values.map(withSteps) : [],
      contours: part.values.map((values) => values.contours && this.picture.addTubes(
        buildTubes(bytes, values.contours), style.contour_color, 0, values.contours.radius, true,
      )),
      mesh: this.picture.addSurface(plain, part.surface_color),
      streamlines: tubes(part.streamlines, style.tube_color),
      tracts: tubes(part.tracts, style.tract_color),
      radius: part.streamlines ? part.streamlines.radius : 0,
    };
  }

  look(index) {
    const shown = this.parts.filter((part) => part.visible);
    const clouds = (shown.length ? shown : this.parts).flatMap((part) => part.clouds);
    this.view.frame(this.scene.views[index].rotation, clouds, this.size(), this.insets(), this.scene.margin);
    this.requestDraw();
  }

  // Pixels at the left and at the right that the colour bar and the controls take, where there is room beside them.
  insets() {
    const panel = document.getElementById('panel').getBoundingClientRect();
    const [width] = this.size(), right = panel.width < FOLDED_WIDTH ? 0 : width - panel.left;
    const left = COLOR_BAR_ROOM * this.keys().length;
    return [left, right].map((taken) => (taken < LARGEST_INSET * width ? taken : 0));
  }

  showLayer(name, shown) {
    this.layers[name] = shown;
    this.requestDraw();
  }

  showPart(index, shown) {
    this.parts[index].visible = shown;
    this.requestDraw();
  }

  // Index of a scale; -1 shows no values.
  showValues(index) {
    this.shownValues = index;
    const scale = this.scene.scales[index];
    for (const part of this.parts) {
      const values = scale && part.values.find(({ name }) => name === scale.name);
      if (part.colored) part.colored.dispose();
      part.colored = values
        ? coloredGeometry(part.surface, values, values.steps, scale, this.scene.style.no_value_color) : null;
      part.someMissing = Boolean(values) && values.steps.includes(NO_VALUE);
      part.mesh.geometry = part.colored || part.plain;
      part.mesh.material.uniforms.showsValues.value = Boolean(values);
    }
    this.requestDraw();
  }

  // Index of a scale of the tubes; -1 shows no values.
  showTubeValues(index) {
    this.shownTubeValues = index;
    const scale = this.scene.tube_scales[index];
    for (const part of this.parts.filter(({ streamlines }) => streamlines)) {
      const values = scale && part.tubeValues.find(({ name }) => name === scale.name);
      if (values) colorTubes(part.streamlines.geometry, values.steps, scale, this.scene.style.no_value_color);
      part.someTubesMissing = Boolean(values) && values.steps.includes(NO_VALUE);
      part.streamlines.material.uniforms.showsValues.value = Boolean(values);
    }
    this.requestDraw();
  }

  // The scales in use, and whether what they colour lacks some values.
  keys() {
    const { scales, tube_scales: tubeScales } = this.scene;
    const missing = (name) => this.parts.some((part) => part.visible && part[name]);
    return [
      { scale: scales[this.shownValues], someMissing: missing('someMissing') },
      { scale: tubeScales[this.shownTubeValues], someMissing: missing('someTubesMissing') },
    ].filter(({ scale }) => scale);
  }

  // `factor` times the radius that each part came with.
  scaleTubes(factor) {
    for (const part of this.parts) {
      if (part.streamlines) part.streamlines.material.uniforms.radius.value = factor * part.radius;
    }
    this.requestDraw();
  }

  size() {
    return [Math.max(this.canvas.clientWidth, 1), Math.max(this.canvas.clientHeight, 1)];
  }

  // Draws soon, and again with finer pixels when nothing has changed for a while.
  requestDraw() {
    if (!this.frameRequest) this.frameRequest = requestAnimationFrame(() => this.draw(screenRatio()));
    clearTimeout(this.finePicture);
    if (screenRatio() < FINE_RATIO) this.finePicture = setTimeout(() => this.draw(FINE_RATIO), FINE_DELAY);
  }

  // `ratio`: pixels of the picture across one of CSS.
  draw(ratio) {
    this.frameRequest = 0;
    const keys = this.keys();
    const shownName = (this.scene.scales[this.shownValues] || {}).name;
    for (const part of this.parts) {
      part.mesh.visible = part.visible && this.layers.surface;
      for (const layer of ['streamlines', 'tracts']) {
        if (part[layer]) part[layer].visible = part.visible && this.layers[layer];
      }
      part.contours.forEach((mesh, index) => {
        const shown = part.visible && this.layers.contours && part.values[index].name === shownName;
        if (mesh) mesh.visible = shown;
      });
    }
    const size = this.size();
    this.picture.resize(...size, ratio);
    this.picture.draw(this.view, this.reach(), keys.length > 0, this.layers.markers && this.scene.markers.length);
    Object.assign(this.overlayCanvas, { width: size[0] * ratio, height: size[1] * ratio });
    this.drawOverlay(this.overlayCanvas.getContext('2d'), size, ratio);
  }

  drawOverlay(context, size, ratio) {
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const markers = this.layers.markers ? this.visibleMarkers() : [];
    this.overlay.draw(context, size, { view: this.view, markers, keys: this.keys() });
  }

  // Farthest vertex from the middle of the picture, with room for tubes.
  reach() {
    if (!this.ball) this.ball = boundingBall(this.parts.map((part) => part.surface.positions));
    return 1.1 * (this.ball.radius + length(minus(this.ball.centre, this.view.centre)));
  }

  visibleMarkers() {
    return this.scene.markers
      .filter(({ part }) => this.parts[part].visible)
      .map(({ places, text }) => ({ place: this.firstSeen(places), text }))
      .filter(({ place }) => place);
  }

  // Where in the picture the first of some places is that is seen from outside.
  firstSeen(places) {
    return places
      .filter(({ normal }) => dot(normal, this.view.rotation[2]) > 0)
      .map(({ position }) => this.view.toPicture(position))
      .find((place) => !this.picture.hides(place, this.view, this.scene.fold_size));
  }

  // The picture with what is written over it, as a PNG data URL.
  screenshot(written = true, ratio = Math.max(screenRatio(), FINE_RATIO)) {
    this.draw(ratio);
    const canvas = document.createElement('canvas');
    Object.assign(canvas, { width: this.canvas.width, height: this.canvas.height });
    const context = canvas.getContext('2d');
    context.drawImage(this.canvas, 0, 0);
    if (written) this.drawOverlay(context, this.size(), ratio);
    return canvas.toDataURL('image/png');
  }
}

function boundingBall(clouds) {
  const box = new THREE.Box3();
  for (const points of clouds) box.union(new THREE.Box3().setFromArray(points));
  const ball = box.getBoundingSphere(new THREE.Sphere());
  return { centre: ball.center.toArray(), radius: ball.radius || 1 };
}

function fillPanel(panel, viewer, scene) {
  const { parts } = viewer;
  panel.heading('View');
  panel.buttons(scene.views.map(({ name }) => name), (index) => viewer.look(index));
  panel.heading('Show');
  if (parts.length > 1) {
    parts.forEach(({ name, visible }, index) => {
      panel.toggle(`part ${index}`, name, visible, (shown) => viewer.showPart(index, shown));
    });
  }
  const there = {
    surface: true,
    contours: parts.some((part) => part.contours.some(Boolean)),
    streamlines: parts.some((part) => part.streamlines),
    tracts: parts.some((part) => part.tracts),
    markers: scene.markers.length > 0,
  };
  for (const name of Object.keys(there).filter((layer) => there[layer])) {
    panel.toggle(name, name[0].toUpperCase() + name.slice(1), true, (shown) => viewer.showLayer(name, shown));
  }
  if (scene.scales.length) {
    panel.heading('Colours');
    const names = ['none', ...scene.scales.map(({ label }) => label)];
    panel.choice('values', names, viewer.shownValues + 1, (index) => viewer.showValues(index - 1));
  }
  if (scene.tube_scales.length) {
    panel.heading('Colours of streamlines');
    const names = ['none', ...scene.tube_scales.map(({ label }) => label)];
    panel.choice('tube values', names, viewer.shownTubeValues + 1, (index) => viewer.showTubeValues(index - 1));
  }
  if (there.streamlines) {
    const first = parts.find((part) => part.streamlines).radius;
    panel.slider('radius', 'Tube radius', [0.1 * first, 2.5 * first], first, (mm) => viewer.scaleTubes(mm / first));
  }
  panel.save('Save picture', () => {
    const link = document.createElement('a');
    link.href = viewer.screenshot();
    link.download = `${scene.title || 'pectinate'}.png`;
    link.click();
  });
  if (scene.notes.length) panel.notes(scene.notes);
}

// Why the page cannot be shown, or null.
function obstacle(context) {
  if (typeof DecompressionStream === 'undefined') return 'This page needs a newer browser (one of 2023 or later).';
  if (!context) return 'This page needs WebGL 2, which this browser does not offer. Switch on hardware acceleration in '
    + 'its settings, or open the page in another browser.';
  return null;
}

async function start() {
  const canvas = document.getElementById('scene'), message = document.getElementById('message');
  const root = document.documentElement;
  const context = canvas.getContext('webgl2', { antialias: true, alpha: false, powerPreference: 'high-performance' });
  const trouble = obstacle(context);
  if (trouble) {
    message.textContent = trouble;
    root.dataset.state = 'unsupported';
    return;
  }
  const scene = JSON.parse(document.getElementById('description').textContent);
  const { style } = scene;
  root.style.setProperty('--paper', cssColor(style.background_color));
  root.style.setProperty('--ink', cssColor(style.ink_color));
  root.style.setProperty('--card', cssColor(style.background_color).replace(')', ', 0.86)').replace('rgb', 'rgba'));
  root.style.setProperty('--line', cssColor(style.ink_color).replace(')', ', 0.2)').replace('rgb', 'rgba'));
  const bytes = await inflate(document.getElementById('arrays').textContent);
  const viewer = new Viewer(scene, bytes, canvas, document.getElementById('overlay'), context);
  if (scene.scales.length) viewer.showValues(scene.shown_values);
  if (scene.tube_scales.length) viewer.showTubeValues(scene.shown_tube_values);
  fillPanel(new Panel(document.getElementById('panel'), scene.title), viewer, scene);
  viewer.look(0);
  followPointers(canvas, viewer.view, () => viewer.requestDraw());
  window.addEventListener('resize', () => viewer.requestDraw());
  canvas.addEventListener('webglcontextrestored', () => viewer.requestDraw());
  viewer.draw(screenRatio());
  message.hidden = true;
  window.pectinate = viewer;
  root.dataset.milliseconds = Math.round(performance.now());
  root.dataset.state = 'ready';
}

start().catch((error) => {
  document.getElementById('message').textContent = `This page cannot be shown: ${error.message}`;
  document.documentElement.dataset.state = 'failed';
  throw error;
});
