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
  // A node that left its graph, as when it goes into a subgraph, may keep its slots; older frontends then ask a graph that is not there.
  return (node.graph && isConnected(node, slot) && node.getInputLink?.(slot)) || null;
}
