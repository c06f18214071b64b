/**
 * The binary answers of the preview routes.
 *
 * @typedef {object} Mesh
 * @property {number} width  of the picture [px]
 * @property {number} height
 * @property {Float32Array} positions  at rest [px], x and y of each vertex
 * @property {Uint32Array} triangles  three vertices each
 * @property {Uint32Array} bodies  first triangle and end of each, from back to front
 * @property {string[]} names
 *
 * @typedef {object} Frame
 * @property {number} number
 * @property {Int16Array} displacements  of each vertex, x and y [unit]
 * @property {Int16Array} anchors  displacement of each rig point of the document, x and y [unit]; 0 of those left out
 * @property {Int16Array} particles  x, y, radius [unit] and kind of each
 *
 * @typedef {object} Header
 * @property {number} frames
 * @property {number} frame_rate
 * @property {number} vertices
 * @property {number} rig_points
 * @property {number[]} [points]  number of each in the document, -1 for none; the same where left out
 * @property {number} unit  [px]
 * @property {boolean} loop
 * @property {number[]} [unheld]  numbers of the bodies that nothing holds
 *
 * @typedef {{type: "header", header: Header} | {type: "frame", frame: Frame} | {type: "end", end: any} | {type: "error", error: string}} PreviewRecord
 */

import { say } from "../host/words.js";

const HEAD = 8;
const [HEADER, FRAME, END, ERROR] = [0, 1, 2, 3];
const KINDS = { float32: Float32Array, uint32: Uint32Array };

/** Takes bytes as they arrive and gives records as soon as they are whole. */
export class RecordReader {
  constructor() {
    this.rest = new Uint8Array(0);
    /** @type {Header | null} */
    this.header = null;
  }

  /**
   * @param {Uint8Array} bytes
   * @returns {PreviewRecord[]}
   */
  push(bytes) {
    const all = this.rest.length ? joined(this.rest, bytes) : bytes;
    const records = [];
    let at = 0;
    while (all.length - at >= HEAD) {
      const view = new DataView(all.buffer, all.byteOffset + at, HEAD);
      const length = view.getUint32(4, true);
      const end = at + HEAD + Math.ceil(length / 4) * 4;
      if (all.length < end) break;
      // A copy, because arrays of more than a byte must begin at a multiple of their size.
      records.push(this.#read(view.getUint8(0), all.slice(at + HEAD, at + HEAD + length)));
      at = end;
    }
    this.rest = all.slice(at);
    return records;
  }

  /**
   * @param {number} type
   * @param {Uint8Array} payload
   * @returns {PreviewRecord}
   */
  #read(type, payload) {
    if (type === FRAME) return { type: "frame", frame: frameOf(payload, /** @type {Header} */ (this.header)) };
    const data = JSON.parse(new TextDecoder().decode(payload));
    if (type === HEADER) {
      this.header = data;
      return { type: "header", header: data };
    }
    if (type === END) return { type: "end", end: data };
    if (type === ERROR) return { type: "error", error: data.error };
    throw new Error(say("The preview sent a record of unknown type {type}.", { type }));
  }
}

/**
 * @param {Uint8Array} payload
 * @param {Header} header
 * @returns {Frame}
 */
function frameOf(payload, header) {
  const { buffer } = payload;
  const anchors = 4 + header.vertices * 4;
  const particles = anchors + header.rig_points * 4;
  const count = new DataView(buffer).getUint32(particles, true);
  return {
    number: new DataView(buffer).getUint32(0, true),
    displacements: new Int16Array(buffer, 4, header.vertices * 2),
    anchors: inDocument(new Int16Array(buffer, anchors, header.rig_points * 2), header.points),
    particles: new Int16Array(buffer, particles + 4, count * 4),
  };
}

/**
 * Displacements of rig points by their numbers in the document: those of bodies that are not there move nothing.
 *
 * @param {Int16Array} anchors
 * @param {number[]} [points]
 */
function inDocument(anchors, points) {
  if (!points) return anchors;
  const placed = new Int16Array(2 * (Math.max(-1, ...points) + 1));
  points.forEach((number, i) => number >= 0 && placed.set(anchors.subarray(2 * i, 2 * i + 2), 2 * number));
  return placed;
}

/**
 * @param {ArrayBuffer} buffer
 * @returns {Mesh}
 */
export function meshOf(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  /** @type {Record<string, any>} */
  const arrays = {};
  let at = 4 + length;
  for (const { name, dtype, shape } of header.arrays) {
    at = Math.ceil(at / 4) * 4;
    const kind = KINDS[/** @type {"float32"} */ (dtype)];
    if (!kind) throw new Error(say("The mesh has an array of unknown type {type}.", { type: dtype }));
    const count = shape.reduce((/** @type {number} */ all, /** @type {number} */ one) => all * one, 1);
    arrays[name] = new kind(buffer, at, count);
    at += count * kind.BYTES_PER_ELEMENT;
  }
  const { positions, triangles, bodies } = arrays;
  return { width: header.width, height: header.height, positions, triangles, bodies, names: header.names ?? [] };
}

/**
 * @param {Uint8Array} first
 * @param {Uint8Array} second
 */
function joined(first, second) {
  const all = new Uint8Array(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}
