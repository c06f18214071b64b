/**
 * Runs one node with all that it needs, and nothing else.
 */

import { holderOf } from "./upstream.js";

/**
 * The id under which the server knows a node: those of the subgraphs around it stand before its own.
 *
 * @param {any} node
 * @param {any} rootGraph
 */
export function executionId(node, rootGraph) {
  const parts = [node.id];
  for (let graph = node.graph; graph && graph !== rootGraph; ) {
    const holder = holderOf(graph, rootGraph);
    if (!holder) break;
    parts.unshift(holder.id);
    graph = holder.graph;
  }
  return parts.join(":");
}

/**
 * @param {any} app  the host's
 * @param {any} node
 * @returns {Promise<unknown>}
 */
export function runNode(app, node) {
  const rootGraph = app.rootGraph ?? app.graph;
  // A host runs a single node only where it is one that may end a run.
  if (!node.constructor?.nodeData?.output_node) return app.queuePrompt(0, 1);
  return app.queuePrompt(0, 1, [executionId(node, rootGraph)]);
}
