// Colours of orientations, quantities and grains. Orientations as in core/rotation.hpp.

const edge = Math.SQRT2 - 1;

/** Matplotlib's viridis (CC0), every sixteenth colour. */
const viridis = [
  [68, 1, 84],
  [72, 24, 106],
  [71, 45, 123],
  [66, 64, 134],
  [59, 82, 139],
  [51, 99, 141],
  [44, 114, 142],
  [38, 130, 142],
  [33, 145, 140],
  [31, 160, 136],
  [40, 174, 128],
  [63, 188, 115],
  [94, 201, 98],
  [132, 212, 75],
  [173, 220, 48],
  [216, 226, 25],
  [253, 231, 37],
];

const grey = [140, 140, 140];
const shades = Array.from({ length: 1024 }, (_, n) => {
  const at = (n / 1023) * (viridis.length - 1);
  const i = Math.min(Math.floor(at), viridis.length - 2);
  return viridis[i].map((c, k) => c + (at - i) * (viridis[i + 1][k] - c));
});

/** Of a share from 0 to 1; grey for NaN. */
export const ramp = (share) => shades[Math.round(1023 * Math.min(Math.max(share, 0), 1))] ?? grey;

export const rampGradient = `linear-gradient(to right, ${viridis.map((c) => `rgb(${c.join()})`).join()})`;

/**
 * IPF colour of the paper's colour (the Rodrigues vector of the orientation in bytes): the sample
 * axis in crystal axes, in the triangle [001] red, [101] green, [111] blue.
 */
export function ipf(red, green, blue, axis) {
  const r = [red, green, blue].map((c) => edge * ((2 * c) / 255 - 1));
  // Row `axis` of the rotation's matrix: ((1 - r.r) 1 + 2 r r^T + 2 [r]x) / (1 + r.r).
  const square = r[0] ** 2 + r[1] ** 2 + r[2] ** 2;
  const j = (axis + 1) % 3,
    k = (axis + 2) % 3;
  const d = [0, 0, 0];
  d[axis] = 1 - square + 2 * r[axis] ** 2;
  d[j] = 2 * (r[axis] * r[j] - r[k]);
  d[k] = 2 * (r[axis] * r[k] + r[j]);
  return ipfOfDirection(d);
}

/** Colour of a direction of the crystal, of any length. */
export function ipfOfDirection(direction) {
  const [x, y, z] = direction.map(Math.abs).sort((a, b) => a - b);
  // In the basis of the corners: [001], [101], [111].
  const weights = [z - y, Math.SQRT2 * (y - x), Math.sqrt(3) * x];
  const most = Math.max(...weights);
  return weights.map((w) => 255 * Math.sqrt(w / most));
}

/** Colours far apart for numbers close together: hues by the golden ratio. */
export function ofGrain(grain) {
  const hue = (grain * 0.61803398875) % 1,
    light = 0.5 + 0.16 * ((grain * 0.754877666) % 1);
  const a = 0.55 * Math.min(light, 1 - light);
  return [0, 8, 4].map((n) => {
    const k = (n + 12 * hue) % 12;
    return 255 * (light - a * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  });
}
