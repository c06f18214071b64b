/** Links of a graph, asked in the way that every frontend has. */

/**
 * @param {any} node
 * @param {number} slot  of an input
 * @returns {boolean} whether something is connected to it
 */
export function isConnected(node, slot) {
  return slot >= 0 && Boolean(node.isInputConnected?.(slot));
}

/**
 * @param {any} node
 * @param {number} slot  of an input
 * @returns {any} what is connected to it; null for nothing
 */
export function linkInto(node, slot) {
  // A node that has left its graph, as when it goes into a subgraph, may keep its slots.
  if (!node.graph || !isConnected(node, slot)) return null;
  // Nodes that hold a subgraph answer this question about the links at its inner end; what every node does asks the outer one.
  const outer = node.subgraph && /** @type {any} */ (globalThis).LiteGraph?.LGraphNode?.prototype.getInputLink;
  return (outer ? outer.call(node, slot) : node.getInputLink?.(slot)) || null;
}
