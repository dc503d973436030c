// The polycrystal as one three.js mesh: triangles that do not share corners, each with its colour.
import { BufferAttribute, BufferGeometry, GLSL3, Mesh, RawShaderMaterial } from 'three';

const vertexShader = `
precision highp float;
precision highp int;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position;
in vec3 colour;
in float lines;
out vec3 place, corner, tint;
flat out int edges;
void main() {
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  place = p.xyz;
  int i = gl_VertexID % 3;
  corner = vec3(i == 0, i == 1, i == 2);
  tint = colour;
  edges = int(lines + 0.5);
  gl_Position = projectionMatrix * p;
}`;

// Edge i runs from corner i to i + 1, opposite to corner i + 2.
const fragmentShader = `
precision highp float;
precision highp int;
uniform bool elements, wires;
uniform vec3 light;
in vec3 place, corner, tint;
flat in int edges;
out vec4 result;
float line(float share, float width) {
  return 1.0 - smoothstep(width - 0.6, width + 0.6, share / fwidth(share));
}
void main() {
  vec3 opposite = vec3(corner.z, corner.x, corner.y);
  float thin = 0.0, thick = 0.0;
  for (int i = 0; i < 3; ++i) {
    thin = max(thin, line(opposite[i], 0.6));
    if ((edges & (1 << i)) != 0) thick = max(thick, line(opposite[i], 1.5));
  }
  if (wires && max(thin, thick) < 0.35) discard;
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  vec3 shaded = tint * (0.74 + 0.26 * max(0.0, dot(normal, light)));
  if (!wires && elements) shaded = mix(shaded, vec3(0.08), 0.3 * thin);
  shaded = mix(shaded, vec3(0.04), 0.85 * thick);
  result = vec4(shaded, 1.0);
}`;

export function makeBody() {
  const material = new RawShaderMaterial({
    vertexShader,
    fragmentShader,
    glslVersion: GLSL3,
    uniforms: {
      elements: { value: true },
      wires: { value: false },
      light: { value: [-0.34, 0.62, 0.7] },
    },
  });
  const body = new Mesh(new BufferGeometry(), material);
  body.frustumCulled = false;
  return body;
}

/** The sides that show: of a grain that is kept, towards one that is not. [triangle, side] pairs. */
export function visibleSides(mesh, kept) {
  const sides = [];
  for (let t = 0; t < mesh.count; ++t) {
    const first = kept[mesh.grains[2 * t]],
      second = kept[mesh.grains[2 * t + 1]];
    if (first !== second) sides.push(2 * t + (first ? 0 : 1));
  }
  return sides;
}

// The second grain sees the triangle from behind: its corners in the order 1 0 2, so that its edges
// are 0, 2 and 1.
const order = [
  [0, 1, 2],
  [1, 0, 2],
];
const flipped = (lines) => (lines & 1) | ((lines & 4) >> 1) | ((lines & 2) << 1);

/** Gives the body these sides of a state; `paint(triangle, side, place)` their colours. */
export function fill(body, { mesh, positions }, sides, paint) {
  const place = new Float32Array(9 * sides.length);
  const colour = new Uint8Array(9 * sides.length);
  const lines = new Uint8Array(3 * sides.length);
  let vertex = 0;
  for (const code of sides) {
    const t = code >> 1;
    const side = code & 1;
    const rgb = paint(t, side, side === 1 ? mesh.second[t] : t);
    const flags = side === 1 ? flipped(mesh.lines[t]) : mesh.lines[t];
    for (const corner of order[side]) {
      const node = mesh.nodes[3 * t + corner];
      for (let i = 0; i < 3; ++i) {
        place[3 * vertex + i] = positions[3 * node + i];
        colour[3 * vertex + i] = rgb[i];
      }
      lines[vertex++] = flags;
    }
  }
  body.geometry.dispose();
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(place, 3));
  geometry.setAttribute('colour', new BufferAttribute(colour, 3, true));
  geometry.setAttribute('lines', new BufferAttribute(lines, 1));
  body.geometry = geometry;
}
