import assert from "node:assert/strict";
import { test } from "node:test";
import { withNode } from "../../nodes/web/js/host/into_view.js";

const WINDOW = { left: 60, top: 90, right: 1280, bottom: 720 };

function seen({ scale, x, y }, { left, top, right, bottom }) {
  return { left: (left + x) * scale, top: (top + y) * scale, right: (right + x) * scale, bottom: (bottom + y) * scale };
}

test("a node that is seen whole leaves the view as it is", () => {
  const view = { scale: 0.8, x: 100, y: 40 };
  assert.deepEqual(withNode(view, { left: 100, top: 200, right: 500, bottom: 600 }, WINDOW), view);
});

test("a node that would fit is moved into the window at the scale there is", () => {
  const view = withNode({ scale: 1, x: 0, y: 0 }, { left: 1100, top: 600, right: 1500, bottom: 900 }, WINDOW);
  assert.equal(view.scale, 1);
  const { left, top, right, bottom } = seen(view, { left: 1100, top: 600, right: 1500, bottom: 900 });
  assert.ok(left >= 60 && top >= 90 && right <= 1280 && bottom <= 720, JSON.stringify([left, top, right, bottom]));
});

test("a node larger than the window is made smaller until it is seen whole", () => {
  const node = { left: 640, top: 330, right: 1280, bottom: 1200 };
  const view = withNode({ scale: 1, x: 0, y: 0 }, node, WINDOW);
  assert.ok(view.scale < 1 && view.scale > 0.5);
  const { left, top, right, bottom } = seen(view, node);
  assert.ok(left >= 60 && top >= 90 && right <= 1280 && bottom <= 720, JSON.stringify([left, top, right, bottom]));
});

test("in a tiny window the lower end of a node is seen, at a scale that can be read", () => {
  const node = { left: 0, top: 0, right: 640, bottom: 900 };
  const view = withNode({ scale: 1, x: 0, y: 0 }, node, { left: 0, top: 0, right: 500, bottom: 300 });
  assert.equal(view.scale, 0.5);
  assert.ok(seen(view, node).bottom <= 300);
});
