/**
 * Painted masks as coloured pictures.
 *
 * @typedef {import("../scene/masks.js").Bitmap} Bitmap
 * @typedef {{canvas: HTMLCanvasElement, context: CanvasRenderingContext2D, image: ImageData, pixels: Uint32Array}} Sheet
 */

import { bitmapOf } from "../scene/masks.js";

/** @type {WeakMap<object, {colour: string, canvas: HTMLCanvasElement}>} of regions, which never change: made once each */
const tinted = new WeakMap();

/** @type {WeakMap<Bitmap, Sheet>} of what is being painted: filled anew for each drawing */
const sheets = new WeakMap();

/**
 * @param {any} region  a mask
 * @param {string} colour  as #rrggbb
 */
export function regionMask(region, colour) {
  let known = tinted.get(region);
  if (known?.colour !== colour) {
    const bitmap = bitmapOf(region);
    tinted.set(region, (known = { colour, canvas: filled(sheetFor(bitmap), bitmap, colour) }));
  }
  return /** @type {HTMLCanvasElement} */ (known?.canvas);
}

/**
 * @param {Bitmap} bitmap  that changes from one drawing to the next
 * @param {string} colour  as #rrggbb
 */
export function draftMask(bitmap, colour) {
  let sheet = sheets.get(bitmap);
  if (!sheet) sheets.set(bitmap, (sheet = sheetFor(bitmap)));
  return filled(sheet, bitmap, colour);
}

/**
 * The rim of a mask, a few pixels wide.
 *
 * @param {any} region  a mask
 * @param {string} colour  as #rrggbb
 */
export function regionEdge(region, colour) {
  const { width, height, bits } = bitmapOf(region);
  const rim = { width, height, bits: new Uint8Array(bits.length) };
  const reach = Math.max(1, Math.round(Math.max(width, height) / 640));
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i++) {
      if (!bits[i]) continue;
      const inside = x < reach || bits[i - reach];
      const whole = inside && (x >= width - reach || bits[i + reach]) && (y < reach || bits[i - reach * width]) && (y >= height - reach || bits[i + reach * width]);
      if (!whole) rim.bits[i] = 1;
    }
  }
  return filled(sheetFor(rim), rim, colour);
}

/** @param {Bitmap} bitmap @returns {Sheet} */
function sheetFor({ width, height }) {
  const canvas = Object.assign(globalThis.document.createElement("canvas"), { width, height });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const image = context.createImageData(width, height);
  return { canvas, context, image, pixels: new Uint32Array(image.data.buffer) };
}

/**
 * @param {Sheet} sheet
 * @param {Bitmap} bitmap
 * @param {string} colour
 */
function filled({ canvas, context, image, pixels }, { bits }, colour) {
  const ink = inkOf(colour);
  for (let i = 0; i < bits.length; i++) pixels[i] = bits[i] ? ink : 0;
  context.putImageData(image, 0, 0);
  return canvas;
}

/** @param {string} colour as one number, whichever byte of it comes first on this machine */
function inkOf(colour) {
  const channels = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return new Uint32Array(new Uint8Array([...channels, 255]).buffer)[0];
}
