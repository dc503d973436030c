// The binary blocks of meshes and states as typed arrays; their layout is in docs/report.md.
import { block } from '../data.js';

const none = 65535,
  steps = 65534;

/** A mesh: corners of triangles, the grains on both sides (0: outside), lines, and its sides. */
async function readMesh(name) {
  const bytes = await block(name);
  const count = bytes.byteLength / 21; // three and two uint32, one byte
  const mesh = {
    count,
    nodes: new Uint32Array(bytes, 0, 3 * count),
    grains: new Uint32Array(bytes, 12 * count, 2 * count),
    lines: new Uint8Array(bytes, 20 * count, count),
  };
  // Which place in a state's values each side of a triangle has.
  mesh.second = new Int32Array(count).fill(-1);
  mesh.sides = count;
  for (let t = 0; t < count; ++t) if (mesh.grains[2 * t + 1] > 0) mesh.second[t] = mesh.sides++;
  return mesh;
}

/** A state: positions, colours and values of the sides. */
async function readState(state, mesh, quantities) {
  const bytes = await block(state.block);
  const nodes = state.surface_nodes;
  const packed = new Uint16Array(bytes, 0, 3 * nodes);
  const positions = new Float32Array(3 * nodes);
  for (let i = 0; i < 3; ++i) {
    const low = state.box[0][i],
      size = state.box[1][i] - low;
    for (let n = 0; n < nodes; ++n) positions[3 * n + i] = low + (size * packed[i * nodes + n]) / steps;
  }
  const colours = new Uint8Array(bytes, 6 * nodes, 3 * mesh.sides);
  let offset = 6 * nodes + 3 * mesh.sides;
  offset += offset % 2;
  const values = {};
  for (const { name } of quantities) {
    values[name] = new Uint16Array(bytes, offset, mesh.sides);
    offset += 2 * mesh.sides;
  }
  return { mesh, positions, colours, values };
}

/** Reads blocks once and keeps them. */
export function library(report) {
  const meshes = new Map(),
    states = new Map();
  const kept = (map, name, read) => {
    if (!map.has(name)) map.set(name, read());
    return map.get(name);
  };
  return (state) =>
    kept(states, state.block, async () =>
      readState(
        state,
        await kept(meshes, state.mesh_block, () => readMesh(state.mesh_block)),
        report.quantities,
      ),
    );
}

/** The number that a value of a block stands for; NaN for none. */
export const unpack = (packed, range) =>
  packed === none ? NaN : range.min + ((range.max - range.min) * packed) / steps;
