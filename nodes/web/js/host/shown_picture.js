/**
 * The picture that a preview beside a node shows of what this node gets too.
 *
 * @typedef {any} GraphNode  of LiteGraph
 */

/** Nodes that show what they get as it is. */
const SHOWING = ["PreviewImage", "SaveImage"];

/**
 * @param {GraphNode} node
 * @param {Record<string, any> | undefined} outputs  what nodes have shown, by their ids
 * @returns {string | null} its path on the server
 */
export function shownPicture(node, outputs) {
  const { graph } = node;
  if (!graph) return null;
  const slot = (node.inputs ?? []).findIndex((/** @type {any} */ input) => input.type === "IMAGE");
  const source = slot < 0 ? null : node.getInputNode?.(slot);
  const link = source && node.getInputLink?.(slot);
  if (!link) return null;
  for (const other of source.getOutputNodes?.(link.origin_slot) ?? []) {
    const [saved] = outputs?.[String(other.id)]?.images ?? [];
    const type = other.comfyClass ?? other.type;
    if (saved && other.graph === graph && SHOWING.includes(type)) return `/view?${new URLSearchParams(saved)}`;
  }
  return null;
}
