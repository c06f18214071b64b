import assert from "node:assert/strict";
import test from "node:test";
import { along, areaOf, distanceToPath, fittingView, isInside, simplified, startingView, toPicture, toStage, zoomed } from "../../nodes/web/js/scene/geometry.js";
import { workOf } from "../../nodes/web/js/scene/document.js";
import { hitTest } from "../../nodes/web/js/scene/hit_testing.js";
import { bitmapOf, brush, emptyBitmap, measured, regionOf, shifted } from "../../nodes/web/js/scene/masks.js";
import { handlesOf, moved, verticesOf, withHandle, withVertex } from "../../nodes/web/js/scene/shapes.js";

const near = (actual, expected, slack = 1e-9) => actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) <= slack, `${actual} is not ${expected}`));
const SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10]];
const STROKE = { list: "strokes", index: 0 };
const RIG = { list: "rig_points", index: 0 };
const scene = (lists) => ({ version: 2, width: 1000, height: 500, ...lists });

test("the stage shows a point of the picture where it was taken from", () => {
  const view = { scale: 2.5, x: 13, y: -7 };
  near(toPicture(view, toStage(view, [123.4, 56.7])), [123.4, 56.7]);
});

test("the fitting view shows the whole picture in the middle", () => {
  const view = fittingView(1000, 500, 516, 516, 8);
  assert.equal(view.scale, 0.5);
  near(toStage(view, [500, 250]), [258, 258]);
});

test("zooming leaves the point under the pointer where it is", () => {
  const view = { scale: 0.5, x: 30, y: 40 };
  const before = toPicture(view, [100, 80]);
  near(toPicture(zoomed(view, [100, 80], 1.7, 0.1), [100, 80]), before);
  assert.equal(zoomed(view, [0, 0], 1e-9, 0.1).scale, 0.1);
});

test("distances, insides and areas", () => {
  assert.equal(distanceToPath([5, 3], [[0, 0], [10, 0]]), 3);
  assert.equal(distanceToPath([-3, 4], [[0, 0], [10, 0]]), 5);
  assert.equal(distanceToPath([-1, 5], SQUARE), Math.hypot(1, 5));
  assert.equal(distanceToPath([-1, 5], SQUARE, true), 1);
  assert.equal(isInside([5, 5], SQUARE), true);
  assert.equal(isInside([11, 5], SQUARE), false);
  assert.equal(areaOf(SQUARE), 100);
  near(along([[0, 0], [0, 0], [10, 0], [10, 10]], 0.75).point, [10, 5]);
});

test("a simplified path stays within its tolerance of the drawn one", () => {
  const drawn = Array.from({ length: 400 }, (_, i) => [i, 40 * Math.sin(i / 40)]);
  const kept = simplified(drawn, 1).map((i) => drawn[i]);
  assert.ok(kept.length < 40 && kept.length > 10, `${kept.length}`);
  assert.deepEqual([kept[0], kept.at(-1)], [drawn[0], drawn.at(-1)]);
  assert.ok(Math.max(...drawn.map((point) => distanceToPath(point, kept))) <= 1);
  assert.deepEqual(simplified([[0, 0], [5, 0], [10, 0]], 0.5), [0, 2]);
});

test("run lengths hold what was painted, in the scene's own form", () => {
  const bitmap = { width: 4, height: 2, bits: Uint8Array.from([1, 1, 0, 0, 0, 1, 1, 1]) };
  const region = regionOf(bitmap);
  assert.deepEqual(region, { type: "mask", width: 4, height: 2, runs: [0, 2, 3, 3] });
  assert.deepEqual(bitmapOf(region).bits, bitmap.bits);
  assert.deepEqual(regionOf({ width: 2, height: 1, bits: new Uint8Array(2) }).runs, [2]);
});

test("the brush paints discs and lines, and takes away again", () => {
  const bitmap = emptyBitmap(400, 200);
  brush(bitmap, [100, 100], [100, 100], 20, 1);
  const disc = measured(bitmap);
  assert.ok(Math.abs(disc.count - Math.PI * 400) < 30, `${disc.count}`);
  near(disc.middle, [100, 100], 0.01);
  brush(bitmap, [100, 100], [200, 100], 20, 1);
  assert.ok(Math.abs(measured(bitmap).count - (Math.PI * 400 + 4000)) < 60);
  brush(bitmap, [0, 100], [400, 100], 30, 0);
  assert.equal(measured(bitmap).count, 0);
  brush(bitmap, [-5, -5], [-5, -5], 10, 1);
  assert.ok(measured(bitmap).count > 0);
});

test("masks of large pictures stay small", () => {
  const bitmap = emptyBitmap(8000, 2000);
  assert.deepEqual([bitmap.width, bitmap.height], [512, 128]);
});

test("a mask moves as a whole", () => {
  const bitmap = { width: 5, height: 1, bits: Uint8Array.from([0, 1, 1, 0, 0]) };
  assert.deepEqual([...bitmapOf(shifted(regionOf(bitmap), 2, 0)).bits], [0, 0, 0, 1, 1]);
  assert.deepEqual([...bitmapOf(shifted(regionOf(bitmap), -2, 0)).bits], [1, 0, 0, 0, 0]);
});

test("every point of an item can be dragged", () => {
  const stroke = { kind: "wind", path: [[0, 0], [10, 0]], radius: 5 };
  assert.deepEqual(verticesOf(STROKE, stroke).map((one) => one.id), ["path.0", "path.1"]);
  assert.deepEqual(withVertex(stroke, "path.1", [12.34, 5]).path, [[0, 0], [12.3, 5]]);
  const rig = { position: [5, 5], region: { type: "polygon", points: SQUARE }, motion: { type: "path", times: [0, 1], points: [[5, 5], [9, 5]] } };
  assert.deepEqual(verticesOf(RIG, rig).map((one) => one.id), ["position", "motion.points.1", "region.points.0", "region.points.1", "region.points.2", "region.points.3"]);
  assert.deepEqual(withVertex(rig, "region.points.2", [20, 20]).region.points[2], [20, 20]);
  const held = withVertex(rig, "position", [6, 7]);
  assert.deepEqual([held.position, held.motion.points, held.region.points], [[6, 7], [[6, 7], [10, 7]], SQUARE]);
});

test("handles stand where the value is, and dragging one there changes nothing", () => {
  const document = scene({});
  const items = [
    [STROKE, { kind: "wind", path: [[100, 100], [300, 100]], radius: 40, strength: 2 }],
    [STROKE, { kind: "wind", path: [[100, 100], [300, 100]], radius: 40, strength: -1.5 }],
    [RIG, { position: [50, 60], region: { type: "circle", radius: 30 }, falloff: 12, motion: { type: "wave", amplitude: 25, direction: [0, 1] } }],
  ];
  for (const [reference, item] of items) {
    const handles = handlesOf(document, reference, item);
    assert.ok(handles.length >= 2);
    for (const { id, at } of handles) assert.deepEqual(withHandle(document, reference, item, id, at), item, id);
  }
  const [, rig] = items[2];
  assert.deepEqual(withHandle(document, RIG, rig, "amplitude", [50 + 30, 60 + 40]).motion, { type: "wave", amplitude: 50, direction: [0.6, 0.8] });
  assert.equal(withHandle(document, RIG, rig, "radius", [50, 100]).region.radius, 40);
});

test("a whole item moves with all that belongs to it", () => {
  const rig = { position: [5, 5], region: { type: "polygon", points: SQUARE }, motion: { type: "path", times: [0, 1], points: [[5, 5], [9, 5]] } };
  const there = moved(scene({}), rig, 10, -2);
  assert.deepEqual(there.position, [15, 3]);
  assert.deepEqual(there.region.points[0], [10, -2]);
  assert.deepEqual(there.motion.points, [[15, 3], [19, 3]]);
});

test("the pointer finds the topmost line, then the smallest area", () => {
  const document = scene({
    strokes: [{ path: [[0, 100], [500, 100]] }, { path: [[0, 100], [500, 100]] }],
    rig_points: [
      { position: [300, 300], region: { type: "circle", radius: 100 } },
      { position: [300, 320], region: { type: "circle", radius: 40 } },
    ],
  });
  assert.deepEqual(hitTest(document, [250, 103], 5, null)?.reference, { list: "strokes", index: 1 });
  assert.equal(hitTest(document, [250, 110], 5, null), null);
  assert.deepEqual(hitTest(document, [310, 335], 5, null)?.reference, { list: "rig_points", index: 1 });
  assert.deepEqual(hitTest(document, [240, 270], 5, null)?.reference, { list: "rig_points", index: 0 });
  const vertex = hitTest(document, [498, 102], 5, { list: "strokes", index: 0 });
  assert.deepEqual(vertex, { reference: { list: "strokes", index: 0 }, part: "vertex", id: "path.1" });
  assert.equal(hitTest(document, [250, 103], 5, null, ["rig_points"]), null);
});

test("painted areas are found where they are painted", () => {
  const bitmap = emptyBitmap(1000, 500);
  brush(bitmap, [256, 128], [256, 128], 20, 1);
  const document = scene({ paint: [{ stiffness: 4, region: regionOf(bitmap) }] });
  assert.deepEqual(hitTest(document, [500, 250], 4, null)?.reference, { list: "paint", index: 0 });
  assert.equal(hitTest(document, [600, 250], 4, null), null);
});

test("a long page begins with a piece of it, full across, around what was drawn and inside its ends", () => {
  const stage = /** @type {const} */ ([600, 320, 10]);
  const shown = (/** @type {any} */ view, /** @type {number} */ length, /** @type {"x" | "y"} */ axis, /** @type {number} */ room) =>
    [-view[axis] / view.scale, (room - view[axis]) / view.scale].map((end) => Math.min(Math.max(end, 0), length));
  const top = startingView(800, 6000, ...stage, [0, 0]);
  assert.ok(Math.abs(800 * top.scale - 300) < 1e-9);
  assert.equal(top.y, 10);
  assert.ok(Math.abs(top.x - (600 - 300) / 2) < 1e-9);
  const [from, to] = shown(startingView(800, 6000, ...stage, [400, 3000]), 6000, "y", 320);
  assert.ok(from < 2700 && to > 3300 && Math.abs((from + to) / 2 - 3000) < 1e-6);
  const foot = startingView(800, 6000, ...stage, [400, 6000]);
  assert.ok(Math.abs(foot.y + 6000 * foot.scale - 310) < 1e-9);
  const wide = startingView(6000, 800, ...stage, [6000, 0]);
  assert.ok(Math.abs(800 * wide.scale - 300) < 1e-9);
  assert.ok(Math.abs(wide.x + 6000 * wide.scale - 590) < 1e-9);
  for (const size of /** @type {[number, number][]} */ ([[1280, 720], [720, 1280], [1000, 2000], [64, 64]])) {
    assert.deepEqual(startingView(...size, ...stage, [0, 0]), fittingView(...size, ...stage));
  }
});

test("the work is where something was drawn last", () => {
  const document = { version: 2, width: 800, height: 6000 };
  assert.deepEqual(workOf(document), [0, 0]);
  assert.deepEqual(workOf({ ...document, strokes: [{ path: [[5, 900], [7, 950]] }] }), [5, 900]);
  const points = [{ x: 1, y: 2 }, { x: 30, y: 4000, positive: false }];
  assert.deepEqual(workOf({ ...document, strokes: [{ path: [[5, 900], [7, 950]] }], query_points: points }), [30, 4000]);
});
