/**
 * Runs one node with all that it needs, and nothing else.
 */

import { warn } from "./upload.js";
import { holderOf } from "./upstream.js";
import { say } from "./words.js";

/** Mode of a node that runs, as LiteGraph numbers them; muted and bypassed ones have others. */
const ON = 0;

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
 * @param {any} node
 * @param {any} rootGraph
 * @returns {boolean} whether the host leaves it out: it is muted or bypassed, or a subgraph around it is
 */
function isLeftOut(node, rootGraph) {
  for (let each = node; each; each = each.graph === rootGraph ? null : holderOf(each.graph, rootGraph)) {
    if ((each.mode ?? ON) !== ON) return true;
  }
  return false;
}

/**
 * @param {any} app  the host's
 * @param {any} node  one that may end a run; the host runs no others alone
 * @returns {Promise<unknown>} false where nothing is queued
 */
export async function runNode(app, node) {
  const rootGraph = app.rootGraph ?? app.graph;
  if (isLeftOut(node, rootGraph)) {
    warn(app, say("It is muted or bypassed: switch it on to run it."), node.title);
    return false;
  }
  return app.queuePrompt(0, 1, [executionId(node, rootGraph)]);
}
