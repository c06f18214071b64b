import assert from "node:assert/strict";
import { test } from "node:test";

import { searchByWords, withWords } from "../../nodes/web/js/host/search.js";

const WIND = { name: "PhysAnimator_Wind", display_name: "Wind (PhysAnimator)", search_aliases: ["breeze", "hair"] };
const ANIMATE = { name: "PhysAnimator_Animate", display_name: "Animate Illustration", search_aliases: ["Hair", "cut out"] };
const OTHER = { name: "CondPair", display_name: "Cond Pair" };
const ALL = [OTHER, WIND, ANIMATE];

/** A page of which the search looks at these keys of nodes. */
function page(keys, found) {
  class Service {
    nodeFuseSearch = { keys, data: ALL };
    searchNode(query, filters, options) {
      return options?.limit ? found.slice(0, options.limit) : found;
    }
  }
  const service = new Service();
  return { service, app: { extensionManager: { _p: { _s: new Map([["nodeDef", { nodeSearchService: service }]]) } } } };
}

test("names that hold what is sought come first, then words, then names that are only like it", () => {
  assert.deepEqual(withWords([OTHER], ALL, "hair"), [WIND, ANIMATE, OTHER]);
  assert.deepEqual(withWords([ANIMATE], ALL, "Animate"), [ANIMATE]);
  assert.deepEqual(withWords([], ALL, "cut o"), [ANIMATE]);
  assert.deepEqual(withWords([OTHER], ALL, ""), [OTHER]);
  assert.deepEqual(withWords([OTHER], ALL, "h"), [OTHER]);
});

test("a page that looks at names alone finds nodes by words as well, within filters and the limit", () => {
  const { service, app } = page(["name", "display_name"], [OTHER]);
  searchByWords(app);
  assert.deepEqual(service.searchNode("hair"), [WIND, ANIMATE, OTHER]);
  assert.deepEqual(service.searchNode("hair", [], { limit: 1 }), [WIND]);
  const not = { filterDef: { matches: (node, value) => node.name !== value }, value: WIND.name };
  assert.deepEqual(service.searchNode("hair", [not]), [ANIMATE, OTHER]);
});

test("a page that looks at words itself, or is of another make, is left as it is", () => {
  const { service, app } = page(["name", "display_name", "search_aliases"], [OTHER]);
  searchByWords(app);
  assert.deepEqual(service.searchNode("hair"), [OTHER]);
  for (const other of [{}, { extensionManager: {} }, page(undefined, []).app]) searchByWords(other);
});
