/**
 * Painted masks: run lengths as the scene document keeps them, and a brush.
 *
 * @typedef {import("./document.js").Point} Point
 * @typedef {{type: "mask", width: number, height: number, runs: number[]}} MaskRegion
 * @typedef {{width: number, height: number, bits: Uint8Array}} Bitmap
 */

/** Longest side of a mask [px]: fine enough for a body part, and short as text. */
const LONGEST = 512;

/** @type {WeakMap<object, Bitmap>} masks are never changed in place, so each is unpacked once */
const unpacked = new WeakMap();

/**
 * @param {number} width  of the picture [px]
 * @param {number} height
 * @returns {Bitmap} without a painted pixel
 */
export function emptyBitmap(width, height) {
  const scale = Math.min(1, LONGEST / Math.max(width, height));
  const size = [Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))];
  return { width: size[0], height: size[1], bits: new Uint8Array(size[0] * size[1]) };
}

/**
 * @param {MaskRegion} region
 * @returns {Bitmap} to be read only
 */
export function bitmapOf(region) {
  const known = unpacked.get(region);
  if (known) return known;
  const bits = new Uint8Array(region.width * region.height);
  let at = 0;
  region.runs.forEach((run, index) => {
    if (index % 2) bits.fill(1, at, at + run);
    at += run;
  });
  const bitmap = { width: region.width, height: region.height, bits };
  unpacked.set(region, bitmap);
  return bitmap;
}

/**
 * @param {Bitmap} bitmap
 * @returns {MaskRegion}
 */
export function regionOf({ width, height, bits }) {
  const runs = [];
  let [value, start] = [0, 0];
  for (let i = 0; i <= bits.length; i++) {
    if (i < bits.length && bits[i] === value) continue;
    runs.push(i - start);
    [value, start] = [1 - value, i];
  }
  return { type: "mask", width, height, runs };
}

/**
 * Paint a round brush along a segment.
 *
 * @param {Bitmap} bitmap  changed in place
 * @param {Point} from  [px of the bitmap]
 * @param {Point} to
 * @param {number} radius  [px of the bitmap]
 * @param {0 | 1} value
 */
export function brush(bitmap, from, to, radius, value) {
  const [left, right] = [Math.min(from[0], to[0]) - radius, Math.max(from[0], to[0]) + radius];
  const [top, bottom] = [Math.min(from[1], to[1]) - radius, Math.max(from[1], to[1]) + radius];
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const squared = dx * dx + dy * dy;
  for (let y = Math.max(0, Math.floor(top)); y < Math.min(bitmap.height, Math.ceil(bottom)); y++) {
    for (let x = Math.max(0, Math.floor(left)); x < Math.min(bitmap.width, Math.ceil(right)); x++) {
      const [px, py] = [x + 0.5 - from[0], y + 0.5 - from[1]];
      const t = squared ? Math.min(Math.max((px * dx + py * dy) / squared, 0), 1) : 0;
      const [ex, ey] = [px - t * dx, py - t * dy];
      if (ex * ex + ey * ey <= radius * radius) bitmap.bits[y * bitmap.width + x] = value;
    }
  }
}

/**
 * @param {MaskRegion} region
 * @param {number} dx  [px of the mask]
 * @param {number} dy
 * @returns {MaskRegion} moved; what leaves the picture is lost
 */
export function shifted(region, dx, dy) {
  const source = bitmapOf(region);
  const [across, down] = [Math.round(dx), Math.round(dy)];
  const bits = new Uint8Array(source.bits.length);
  for (let y = 0; y < source.height; y++) {
    for (let x = 0; x < source.width; x++) {
      const [u, v] = [x - across, y - down];
      if (u < 0 || v < 0 || u >= source.width || v >= source.height) continue;
      bits[y * source.width + x] = source.bits[v * source.width + u];
    }
  }
  return regionOf({ width: source.width, height: source.height, bits });
}

/**
 * @param {Bitmap} bitmap
 * @returns {{count: number, middle: Point}} painted pixels and their middle [px of the bitmap]
 */
export function measured({ width, bits }) {
  let [count, x, y] = [0, 0, 0];
  for (let i = 0; i < bits.length; i++) {
    if (!bits[i]) continue;
    count += 1;
    x += (i % width) + 0.5;
    y += Math.floor(i / width) + 0.5;
  }
  return { count, middle: count ? [x / count, y / count] : [0, 0] };
}
