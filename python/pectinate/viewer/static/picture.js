// Draws the scene: first the depths of the surfaces, blurred, then everything in its light.

const SURFACE_LAYER = 1;
const BLUR_REACH = 24;
// The blur is computed on cells this many of which make its deviation.
const DEVIATION_CELLS = 4;
const LARGEST_CELL = 16;

class Picture {
  constructor(canvas, scene, context) {
    this.scene = scene;
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.autoClear = false;
    this.camera = new THREE.OrthographicCamera();
    this.world = new THREE.Scene();
    this.uniforms = sharedUniforms(scene);
    this.depthMaterial = material(DEPTH_VERTEX, DEPTH_FRAGMENT, {}, THREE.DoubleSide);
    this.targets = [0, 1].map(() => new THREE.WebGLRenderTarget(1, 1, {
      minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, stencilBuffer: false,
    }));
    this.blur = material(BLUR_VERTEX, BLUR_FRAGMENT, {
      source: { value: null }, sourceSize: { value: new THREE.Vector2() }, direction: { value: new THREE.Vector2() },
      deviation: { value: 1 },
    }, THREE.DoubleSide, { BLUR_REACH });
    this.blurCamera = new THREE.Camera();
    this.blurQuad = new THREE.Scene();
    const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.blur);
    quad.frustumCulled = false;
    this.blurQuad.add(quad);
  }

  addSurface(geometry, outside) {
    const { inside_color: inside } = this.scene.style;
    return this.add(geometry, material(SURFACE_VERTEX, SURFACE_FRAGMENT, {
      ...this.uniforms, surfaceColor: { value: outside }, insideColor: { value: inside }, showsValues: { value: false },
    }, THREE.DoubleSide, this.defines()), [0, SURFACE_LAYER]);
  }

  addTubes(geometry, color, gloss, radius, calm = false) {
    return this.add(geometry, material(TUBE_VERTEX, TUBE_FRAGMENT, {
      ...this.uniforms, tubeColor: { value: color }, tubeGloss: { value: gloss }, radius: { value: radius },
      height: { value: geometry.userData.height },
      showsValues: { value: false }, calm: { value: calm },
    }, THREE.FrontSide, this.defines()), [0]);
  }

  add(geometry, its, layers) {
    const mesh = new THREE.Mesh(geometry, its);
    mesh.frustumCulled = false;
    mesh.layers.disableAll();
    for (const layer of layers) mesh.layers.enable(layer);
    this.world.add(mesh);
    return mesh;
  }

  defines() {
    return { LIGHT_COUNT: this.scene.light.lights.length };
  }

  resize(width, height, ratio) {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
  }

  // All that is drawn lies within `reach` mm of the middle of the picture. With `asksDepths`, `hides` can be called.
  draw(view, reach, showsValues, asksDepths) {
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    const mmPerPixel = view.mmPerPixel / this.renderer.getPixelRatio();
    this.aim(view, reach, size, mmPerPixel);
    const { style, fold_size: foldSize } = this.scene;
    this.uniforms.pictureSize.value.copy(size);
    this.uniforms.depthRange.value = this.camera.far - this.camera.near;
    this.uniforms.foldLosses.value.set(...(showsValues ? style.value_fold_losses : style.fold_losses));
    this.drawSurroundings(size, 0.5 * foldSize / mmPerPixel, asksDepths);
    this.camera.layers.set(0);
    this.renderer.setRenderTarget(null);
    this.renderer.setClearColor(new THREE.Color(...style.background_color), 1);
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
  }

  aim(view, reach, size, mmPerPixel) {
    const [right, up, towards] = view.rotation.map((row) => new THREE.Vector3(...row));
    const { camera } = this;
    camera.right = 0.5 * size.x * mmPerPixel;
    camera.top = 0.5 * size.y * mmPerPixel;
    camera.left = -camera.right;
    camera.bottom = -camera.top;
    camera.near = 0;
    camera.far = 2 * reach;
    camera.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(right, up, towards));
    camera.position.set(...view.centre).addScaledVector(towards, reach);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  // Depths of the surfaces as the three box blurs of the project's pictures leave them, `radius` pixels each way.
  drawSurroundings(size, radius, asksDepths) {
    const deviation = Math.sqrt(Math.max((2 * radius + 1) ** 2 - 1, 1) / 4);
    const cell = Math.min(Math.max(deviation / DEVIATION_CELLS, 1), LARGEST_CELL);
    const [width, height] = [size.x, size.y].map((pixels) => Math.max(Math.ceil(pixels / cell), 1));
    for (const target of this.targets) target.setSize(width, height);
    this.renderer.setClearColor(0, 0);
    this.camera.layers.set(SURFACE_LAYER);
    this.world.overrideMaterial = this.depthMaterial;
    this.renderer.setRenderTarget(this.targets[0]);
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
    this.world.overrideMaterial = null;
    if (asksDepths) this.readDepths(width, height);
    const { uniforms } = this.blur;
    uniforms.sourceSize.value.set(width, height);
    uniforms.deviation.value = Math.min(deviation / cell, BLUR_REACH / 2);
    for (const [from, to, x, y] of [[0, 1, 1, 0], [1, 0, 0, 1]]) {
      uniforms.source.value = this.targets[from].texture;
      uniforms.direction.value.set(x, y);
      this.renderer.setRenderTarget(this.targets[to]);
      this.renderer.clear();
      this.renderer.render(this.blurQuad, this.blurCamera);
    }
    this.uniforms.surroundings.value = this.targets[0].texture;
    this.uniforms.surroundingsSize.value.set(width, height);
  }

  readDepths(width, height) {
    const bytes = new Uint8Array(4 * width * height);
    this.renderer.readRenderTargetPixels(this.targets[0], 0, 0, width, height, bytes);
    this.depths = { width, height, bytes };
  }

  // Whether a surface lies in front of a place, in the coordinates of `View.toPicture`, by more than `slack` mm.
  hides([x, y, z], view, slack) {
    const { width, height, bytes } = this.depths;
    const across = 0.5 + (x * view.mmPerPixel) / (2 * this.camera.right);
    const upwards = 0.5 + (y * view.mmPerPixel) / (2 * this.camera.top);
    if (!(across >= 0 && across < 1 && upwards >= 0 && upwards < 1)) return false;
    const cell = 4 * (Math.floor(upwards * height) * width + Math.floor(across * width));
    if (bytes[cell + 2] === 0) return false;
    const share = (bytes[cell] + bytes[cell + 1] / 255) / 255;
    return share * this.camera.far < 0.5 * this.camera.far - z - slack;
  }
}

function sharedUniforms({ light, style, fold_size: foldSize }) {
  return {
    lightDirections: { value: light.lights.map(({ direction }) => new THREE.Vector3(...direction)) },
    lightStrengths: { value: light.lights.map(({ strength }) => strength) },
    sky: { value: light.sky },
    ground: { value: light.ground },
    edgeDarkness: { value: style.edge_darkness },
    shadowColor: { value: new THREE.Vector3(...style.shadow_color) },
    glossDirection: { value: new THREE.Vector3(...light.gloss_direction) },
    glossExponent: { value: light.gloss_exponent },
    valueShade: { value: light.value_shade },
    surroundings: { value: null },
    surroundingsSize: { value: new THREE.Vector2() },
    pictureSize: { value: new THREE.Vector2() },
    depthRange: { value: 1 },
    foldReach: { value: 0.5 * foldSize },
    foldLosses: { value: new THREE.Vector3() },
  };
}

function material(vertexShader, fragmentShader, uniforms, side, defines = {}) {
  return new THREE.ShaderMaterial({
    vertexShader, fragmentShader, uniforms, side, defines, blending: THREE.NoBlending,
  });
}
