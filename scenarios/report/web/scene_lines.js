// ---- lines, points and edges of boxes
export const WHITE = [1, 1, 1];

/** Returns the length of a line. Math.hypot() is slow. */
function lengthOf(ends, i) {
  let sum = 0;
  for (let k = i; k < i + 3; k++) sum += (ends[k] - ends[k + 3]) ** 2;
  return Math.sqrt(sum);
}

/** Returns the geometry of lines, six numbers each, with their lengths, by which they fade. */
export function lineGeometry(ends) {
  const geometry = new THREE.BufferGeometry(), at = new Float32Array(ends),
    span = new Float32Array(at.length / 3);
  for (let i = 0; i < span.length; i += 2)
    span[i] = span[i + 1] = lengthOf(at, 3 * i);
  geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
  geometry.setAttribute("span", new THREE.BufferAttribute(span, 1));
  return geometry;
}

// ---- holes in wrappers, through which contacts are seen
const MOST_HOLES = 8;

/** The uniforms of HOLES. `lens`: see fadingLines(). */
export const holeUniforms = ({ holes, holeCount, pixel }) => ({ holes, holeCount, pixel });

/** Sets the holes: balls, {centre, radius} in the world; of many, the largest. */
export function setHoles(lens, balls) {
  const most = balls.sort((p, q) => q.radius - p.radius).slice(0, MOST_HOLES);
  lens.holeCount.value = most.length;
  most.forEach(({ centre, radius }, i) => lens.holes.value[i].set(centre.x, centre.y, centre.z, radius));
}

/** Returns a lens without holes; see BodiesCanvas. */
export const lensOf = (size) => ({
  size, depths: new THREE.Vector2(0, 1), pixel: { value: 1 }, holeCount: { value: 0 },
  holes: { value: Array.from({ length: MOST_HOLES }, () => new THREE.Vector4()) },
});

/** Of a fragment shader: intoHole() returns how far the fragment, at `seen` before the camera, is inside of a
    hole, which reaches from a ball, its back included, to the camera, as wide on the screen all the way. */
export const HOLES = `
  uniform vec4 holes[${MOST_HOLES}];
  uniform int holeCount;
  uniform float pixel;
  uniform mat4 projectionMatrix;
  varying vec3 seen;
  float intoHole() {
    float most = -1e9;
    bool parallel = projectionMatrix[2][3] == 0.0;
    for (int i = 0; i < ${MOST_HOLES}; i++) {
      if (i >= holeCount) break;
      vec3 centre = (viewMatrix * vec4(holes[i].xyz, 1.0)).xyz;
      vec3 ahead = parallel ? vec3(0.0, 0.0, -1.0) : normalize(centre);
      float depth = dot(seen, ahead), until = dot(centre, ahead);
      vec3 aside = parallel ? seen - centre : (seen - depth * ahead) * until / max(depth, 1e-6);
      float away = length(aside - ahead * dot(aside, ahead));
      if (depth < until + holes[i].w) most = max(most, holes[i].w - away);
    }
    return most;
  }`;

/** Returns lines one pixel wide that fade where they are short on the screen, and with their distance.
    `lens`: size of the picture and depths, kept by the view. `opens`: not drawn in holes. */
export function fadingLines(ends, colour, opacity, lens, { depthWrite = false, opens = false } = {}) {
  const material = new THREE.ShaderMaterial({
    uniforms: {
      colour: { value: colour }, opacity: { value: opacity }, size: { value: lens.size },
      depths: { value: lens.depths }, ...holeUniforms(lens),
    },
    vertexShader: `
      attribute float span;
      uniform vec2 size, depths;
      varying float shown;
      varying vec3 seen;
      void main() {
        vec4 at = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * at;
        seen = at.xyz;
        float pixels = span * projectionMatrix[1][1] * size.y / 2.0 / gl_Position.w;
        shown = smoothstep(3.0, 60.0, pixels) * mix(1.0, 0.15,
            clamp((-at.z - depths.x) / depths.y, 0.0, 1.0));
      }`,
    fragmentShader: `
      uniform vec3 colour;
      uniform float opacity;
      varying float shown;
      ${HOLES}
      void main() {
        if (${opens} && intoHole() > 0.0) discard;
        gl_FragColor = vec4(colour, opacity * shown);
      }`,
    transparent: true,
    depthWrite,
  });
  const lines = new THREE.LineSegments(lineGeometry(ends), material);
  lines.frustumCulled = false;
  return lines;
}

/** Returns the geometry of lines of any width, in pixels: browsers draw WebGL lines one pixel wide. `ends`:
    six numbers for each line. A line that starts where the one before it ends continues its dashes. */
export function thickGeometry(ends) {
  const count = ends.length / 6, at = new Float32Array(12 * count), other = new Float32Array(12 * count),
    side = new Float32Array(4 * count),
    along = new Float32Array(4 * count),
    index = new Uint32Array(6 * count);
  let length = 0;
  for (let l = 0, e = 0; l < count; l++, e += 6) {
    if (l === 0 || [0, 1, 2].some((c) => ends[e + c] !== ends[e + c - 3])) length = 0;
    const until = length + lengthOf(ends, e);
    for (let k = 0; k < 4; k++) { // two corners at each end
      for (let c = 0; c < 3; c++) {
        at[12 * l + 3 * k + c] = ends[e + c + (k < 2 ? 0 : 3)];
        other[12 * l + 3 * k + c] = ends[e + c + (k < 2 ? 3 : 0)];
      }
      side[4 * l + k] = k % 3 ? -1 : 1;
      along[4 * l + k] = k < 2 ? length : until;
    }
    length = until;
    index.set([4 * l, 4 * l + 1, 4 * l + 2, 4 * l + 2, 4 * l + 1, 4 * l + 3], 6 * l);
  }
  const geometry = new THREE.BufferGeometry();
  for (const [name, array, size] of [["position", at, 3], ["other", other, 3], ["side", side, 1],
      ["along", along, 1]])
    geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

/** `ends`: as above, or their geometry. */
export function thickLines(ends, material) {
  const mesh = new THREE.Mesh(ends.isBufferGeometry ? ends : thickGeometry(ends), material);
  mesh.frustumCulled = false;
  return mesh;
}

/** `lens`: see fadingLines(). `dash`: length of a dash and its gap in pixels; 0: no dashes. `hides`: bodies
    hide the line, except where it is at most a few pixels behind their faces. */
export function thickMaterial(colour, width, lens, { opacity = 1, dash = 0, hides = false } = {}) {
  return new THREE.ShaderMaterial({
    uniforms: {
      colour: { value: new THREE.Color(...colour) }, opacity: { value: opacity }, width: { value: width },
      dash: { value: dash }, size: { value: lens.size }, pixel: lens.pixel,
    },
    vertexShader: `
      attribute vec3 other;
      attribute float side, along;
      uniform vec2 size;
      uniform float width, pixel;
      varying float on;
      void main() {
        vec4 at = modelViewMatrix * vec4(position, 1.0);
        vec4 a = projectionMatrix * at;
        vec4 b = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
        vec2 way = (b.xy / b.w - a.xy / a.w) * size;
        way = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
        a.xy += (vec2(-way.y, way.x) * side - 0.4 * way) * width / size * a.w; // longer: lines join
        vec4 near = projectionMatrix * (at + vec4(0.0, 0.0, 4.0 * pixel, 0.0));
        a.z = near.z / near.w * a.w;
        on = along / pixel;
        gl_Position = a;
      }`,
    fragmentShader: `
      uniform vec3 colour;
      uniform float opacity, dash;
      varying float on;
      void main() {
        if (dash > 0.0 && mod(on, dash) > 0.6 * dash) discard;
        gl_FragColor = vec4(colour, opacity);
      }`,
    side: THREE.DoubleSide,
    transparent: true,
    depthTest: hides,
    depthWrite: false,
  });
}

/** Returns round points of a size in CSS pixels, with a rim, seen through everything. */
export function roundPoints(positions, colour, size, rim = WHITE) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions), 3));
  const points = new THREE.Points(
    geometry,
    new THREE.ShaderMaterial({
      uniforms: {
        colour: { value: new THREE.Color(...colour) }, rim: { value: new THREE.Color(...rim) },
        size: { value: size * Math.min(2, window.devicePixelRatio || 1) },
      },
      vertexShader: `
        uniform float size;
        void main() {
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          gl_PointSize = size;
        }`,
      fragmentShader: `
        uniform vec3 colour, rim;
        void main() {
          float r = length(gl_PointCoord - 0.5);
          if (r > 0.5) discard;
          gl_FragColor = vec4(r > 0.36 ? rim : colour, 1.0);
        }`,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    }),
  );
  points.frustumCulled = false;
  return points;
}

/** Returns the twelve edges of boxes, six numbers each. `places`: centre and three half axes of each box. */
export function boxEdges(places, boxes) {
  const out = [],
    corner = (at, signs, i) =>
      places[at + i] + signs.reduce((x, s, axis) => x + s * places[at + 3 + 3 * axis + i], 0);
  for (const box of boxes)
    for (let axis = 0; axis < 3; axis++)
      for (const s of [-1, 1])
        for (const t of [-1, 1])
          for (const end of [-1, 1]) {
            const signs = [0, 0, 0];
            signs[axis] = end;
            signs[(axis + 1) % 3] = s;
            signs[(axis + 2) % 3] = t;
            for (let i = 0; i < 3; i++) out.push(corner(12 * box, signs, i));
          }
  return out;
}
