// The light of the project's pictures (pectinate/figure/shading.py), computed for each pixel. Normals are in picture
// coordinates: x right, y up, z towards the viewer. Colours are display RGB.

const LIGHT_FUNCTIONS = `
  uniform vec3 lightDirections[LIGHT_COUNT];
  uniform float lightStrengths[LIGHT_COUNT];
  uniform float sky, ground, edgeDarkness, glossExponent, valueShade;
  uniform vec3 glossDirection;

  float light(vec3 n, float edge) {
    float brightness = ground + (sky - ground) * (0.5 + 0.5 * n.y);
    for (int i = 0; i < LIGHT_COUNT; i++) brightness += lightStrengths[i] * max(dot(n, lightDirections[i]), 0.0);
    float turnedAway = 1.0 - clamp(n.z, 0.0, 1.0);
    return brightness * (1.0 - edge * turnedAway * turnedAway * turnedAway);
  }

  float valueLight(vec3 n, float edge) {
    float facing = light(vec3(0.0, 0.0, 1.0), edge);
    return 1.0 - valueShade * max(1.0 - light(n, edge) / facing, 0.0);
  }

  float gloss(vec3 n) {
    return pow(clamp(dot(n, glossDirection), 0.0, 1.0), glossExponent);
  }`;

// Blurred depths travel in bytes, which any device can draw to: 16 bits of depth times weight, 16 bits of weight.
const PACKING = `
  vec4 pack(vec2 sums) {
    vec2 high = floor(sums * 255.0), low = sums * 255.0 - high;
    return vec4(high.x / 255.0, low.x, high.y / 255.0, low.y);
  }

  vec2 unpack(vec4 bytes) {
    return bytes.rb + bytes.ga / 255.0;
  }`;

// How far a pixel lies below its surroundings darkens it.
const FOLD_FUNCTIONS = `${PACKING}
  uniform sampler2D surroundings;
  uniform vec2 surroundingsSize, pictureSize;
  uniform float depthRange, foldReach;
  uniform vec3 foldLosses;

  vec2 surroundingsAt(vec2 cell) {
    return unpack(texture2D(surroundings, (clamp(cell, vec2(0.0), surroundingsSize - 1.0) + 0.5) / surroundingsSize));
  }

  vec3 foldShadow() {
    vec2 place = gl_FragCoord.xy / pictureSize * surroundingsSize - 0.5;
    vec2 cell = floor(place), share = place - cell;
    vec2 below = mix(surroundingsAt(cell), surroundingsAt(cell + vec2(1.0, 0.0)), share.x);
    vec2 above = mix(surroundingsAt(cell + vec2(0.0, 1.0)), surroundingsAt(cell + vec2(1.0, 1.0)), share.x);
    vec2 sums = mix(below, above, share.y);
    if (sums.y < 0.004) return vec3(1.0);
    float depth = (gl_FragCoord.z - sums.x / sums.y) * depthRange;
    return 1.0 - foldLosses * clamp(depth / foldReach, 0.0, 1.0);
  }`;

const SURFACE_VERTEX = `
  attribute vec3 valueColor;
  varying vec3 vNormal, vColor;
  void main() {
    vNormal = normalMatrix * normal;
    vColor = valueColor;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const SURFACE_FRAGMENT = `${LIGHT_FUNCTIONS}${FOLD_FUNCTIONS}
  uniform vec3 surfaceColor, insideColor, shadowColor;
  uniform bool showsValues;
  varying vec3 vNormal, vColor;

  vec3 shade(float brightness) {
    return mix(shadowColor, vec3(1.0), brightness);
  }

  void main() {
    vec3 n = normalize(vNormal);
    vec3 color;
    if (!gl_FrontFacing) color = insideColor * shade(light(-n, edgeDarkness));
    else if (showsValues) color = vColor * valueLight(n, edgeDarkness);
    else color = surfaceColor * shade(light(n, edgeDarkness));
    gl_FragColor = vec4(clamp(color, 0.0, 1.0) * foldShadow(), 1.0);
  }`;

// A tube's vertex is its centre and a unit vector away from it, of which the part along `up` becomes shorter in flat
// tubes, and that of the normal longer; the radius comes last. Its light is computed at the
// vertices, as in the pictures: highlights on dark tubes become broad and calm.
const TUBE_VERTEX = `${LIGHT_FUNCTIONS}
  attribute vec3 offset, up, valueColor;
  attribute float thickness;
  uniform bool showsValues, calm;
  uniform float radius, height;
  uniform vec3 tubeColor;
  uniform float tubeGloss;
  varying vec3 vColor;
  void main() {
    vec3 raised = dot(offset, up) * up;
    vec3 n = normalize(normalMatrix * (offset + (1.0 / height - 1.0) * raised));
    if (showsValues || calm) vColor = (showsValues ? valueColor : tubeColor) * valueLight(n, 0.0);
    else vColor = clamp(tubeColor * light(n, 0.0) + tubeGloss * gloss(n), 0.0, 1.0);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position + radius * thickness * (offset - (1.0 - height) * raised), 1.0);
  }`;

const TUBE_FRAGMENT = `${FOLD_FUNCTIONS}
  varying vec3 vColor;
  void main() {
    gl_FragColor = vec4(vColor * foldShadow(), 1.0);
  }`;

const DEPTH_VERTEX = `
  void main() {
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const DEPTH_FRAGMENT = `${PACKING}
  void main() {
    gl_FragColor = pack(vec2(gl_FragCoord.z, 1.0));
  }`;

const BLUR_VERTEX = `
  void main() {
    gl_Position = vec4(position.xy, 0.0, 1.0);
  }`;

// One direction of a Gaussian blur; what lies beyond the border counts as nothing.
const BLUR_FRAGMENT = `${PACKING}
  uniform sampler2D source;
  uniform vec2 sourceSize, direction;
  uniform float deviation;
  void main() {
    vec2 sums = vec2(0.0);
    float total = 0.0;
    for (int i = -BLUR_REACH; i <= BLUR_REACH; i++) {
      float weight = exp(-0.5 * float(i * i) / (deviation * deviation));
      vec2 place = (gl_FragCoord.xy + float(i) * direction) / sourceSize;
      total += weight;
      if (all(greaterThan(place, vec2(0.0))) && all(lessThan(place, vec2(1.0)))) {
        sums += weight * unpack(texture2D(source, place));
      }
    }
    gl_FragColor = pack(sums / total);
  }`;
