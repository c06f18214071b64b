/**
 * The picture that a node will get, as far as the graph tells it before it has run.
 *
 * @typedef {any} GraphNode  of LiteGraph
 */

import { isConnected, linkInto } from "./links.js";

/** Origin of a link that comes from outside of a subgraph. */
const SUBGRAPH_INPUT = -10;
const FARTHEST = 200;
const BYPASSED = 4;

/** Where the server has the illustration that comes with the pack. */
export const EXAMPLE = "/physanimator/example";

/**
 * The picture of the node nearest upstream that has one before it has run.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 * @returns {string | null} its path on the server
 */
export function upstreamPicture(node, rootGraph) {
  const open = sourcesOf(node, rootGraph, isPicture(node) ? "IMAGE" : null);
  const seen = new Set();
  for (let one = open.shift(); one && seen.size < FARTHEST; one = open.shift()) {
    if (seen.has(one)) continue;
    seen.add(one);
    const path = pictureOf(one);
    if (path) return path;
    open.push(...sourcesOf(one, rootGraph, null));
  }
  return null;
}

/**
 * Whether the picture that a node needs comes from another node, through the ends of subgraphs too.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 */
export function getsPicture(node, rootGraph) {
  return sourcesOf(node, rootGraph, "IMAGE").length > 0;
}

/** @param {GraphNode} node whether a picture is connected to the node itself */
function isPicture(node) {
  return (node.inputs ?? []).some((/** @type {any} */ input, /** @type {number} */ slot) => input.type === "IMAGE" && isConnected(node, slot));
}

/** @param {GraphNode} node */
function pictureOf(node) {
  const type = node.comfyClass ?? node.type ?? "";
  if (node.mode === BYPASSED) return null;
  if (type === "PhysAnimator_ExampleIllustration") return EXAMPLE;
  if (!/LoadImage/.test(type)) return null;
  const value = node.widgets?.find((/** @type {any} */ widget) => widget.name === "image")?.value;
  return typeof value === "string" && value ? pathOfFile(value) : null;
}

/**
 * The nodes on which a node depends directly.
 *
 * @param {GraphNode} node
 * @param {any} rootGraph
 * @param {string | null} type  of the inputs to follow; null for all
 * @returns {GraphNode[]}
 */
function sourcesOf(node, rootGraph, type) {
  const slots = (node.inputs ?? []).flatMap((/** @type {any} */ input, /** @type {number} */ slot) => (!type || input.type === type ? [slot] : []));
  return slots.map((/** @type {number} */ slot) => sourceOf(node, slot, rootGraph)).filter(Boolean);
}

/**
 * @param {GraphNode} node
 * @param {number} slot  of an input
 * @param {any} rootGraph
 * @returns {GraphNode | null}
 */
function sourceOf(node, slot, rootGraph) {
  const { graph } = node;
  const link = linkInto(node, slot);
  if (!link || !graph) return null;
  if (link.origin_id !== SUBGRAPH_INPUT) return graph.getNodeById(link.origin_id);
  const holder = holderOf(graph, rootGraph);
  return holder ? sourceOf(holder, link.origin_slot, rootGraph) : null;
}

/**
 * The node that stands for a subgraph.
 *
 * @param {any} subgraph
 * @param {any} rootGraph
 * @returns {GraphNode | null}
 */
export function holderOf(subgraph, rootGraph) {
  const graphs = [rootGraph, ...(rootGraph?.subgraphs?.values?.() ?? [])];
  for (const graph of graphs) {
    const holder = (graph?.nodes ?? []).find((/** @type {any} */ one) => one.subgraph === subgraph);
    if (holder) return holder;
  }
  return null;
}

/**
 * @param {string} file  as a Load Image widget has it
 * @returns {string} its path on the server
 */
export function pathOfFile(file) {
  return `/view?${viewQuery(file)}`;
}

/**
 * What the server's page for files is asked for.
 *
 * @param {string} file  as a Load Image widget has it
 */
function viewQuery(file) {
  const [, path, type] = file.match(/^(.*?)(?: \[(input|output|temp)\])?$/) ?? [file, file];
  const cut = path.lastIndexOf("/");
  return new URLSearchParams({ filename: path.slice(cut + 1), subfolder: cut < 0 ? "" : path.slice(0, cut), type: type ?? "input" });
}
