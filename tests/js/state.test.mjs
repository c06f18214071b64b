import assert from "node:assert/strict";
import test from "node:test";
import { emptyDocument, parseDocument, serialise, valueAt, withAdded, withItem, withoutItems, withValue } from "../../nodes/web/js/scene/document.js";
import { History } from "../../nodes/web/js/scene/history.js";
import { newLead, newStroke, newWave, titleOf } from "../../nodes/web/js/scene/items.js";
import { rescaled } from "../../nodes/web/js/scene/rescaling.js";
import { departures, edgesOf, spansOf, withEdge } from "../../nodes/web/js/scene/timing.js";

test("unknown fields survive reading, changing and writing", () => {
  const text = '{"version":2,"width":10,"height":20,"future":{"a":[1]},"strokes":[{"kind":"wind","path":[[0,0],[1,1]],"odd":7}]}';
  const document = parseDocument(text);
  assert.equal(serialise(document), text);
  const changed = withItem(document, { list: "strokes", index: 0 }, { ...document.strokes[0], strength: 3 });
  assert.deepEqual(changed.future, { a: [1] });
  assert.equal(changed.strokes[0].odd, 7);
  assert.equal(document.strokes[0].strength, undefined);
});

test("a document that cannot be shown is refused in a sentence", () => {
  assert.throws(() => parseDocument("{"), /not valid JSON/);
  assert.throws(() => parseDocument("[]"), /object in braces/);
  assert.throws(() => parseDocument('{"version":3,"width":1,"height":1}'), /version 3/);
  assert.throws(() => parseDocument('{"version":2,"width":1,"height":1,"strokes":{}}'), /strokes must be a list/);
  assert.throws(() => parseDocument('{"version":2}'), /width and height/);
});

test("items are added, removed and addressed", () => {
  const one = withAdded(emptyDocument(100, 50), "strokes", { kind: "wind" });
  const two = withAdded(one.document, "strokes", { kind: "repel" });
  assert.deepEqual(two.reference, { list: "strokes", index: 1 });
  assert.deepEqual(withoutItems(two.document, [one.reference]).strokes, [{ kind: "repel" }]);
  assert.equal(two.document.strokes.length, 2);
});

test("nested values are set and removed without touching the rest", () => {
  const item = { region: { type: "circle", radius: 3 }, end: 4 };
  assert.deepEqual(withValue(item, "region.radius", 5), { region: { type: "circle", radius: 5 }, end: 4 });
  assert.deepEqual(withValue(item, "end", undefined), { region: { type: "circle", radius: 3 } });
  assert.equal(valueAt(item, "region.radius"), 3);
  assert.equal(valueAt(item, "motion.type"), undefined);
});

test("undo and redo go through every step, and a new step forgets the undone ones", () => {
  const history = new History("a");
  for (const state of ["b", "c"]) history.push(state);
  assert.equal(history.undo(), true);
  assert.equal(history.present, "b");
  assert.equal(history.redo(), true);
  assert.equal(history.present, "c");
  history.undo();
  history.push("d");
  assert.equal(history.redo(), false);
  history.undo();
  history.undo();
  assert.equal(history.present, "a");
  assert.equal(history.undo(), false);
});

test("typing into one field is one step", () => {
  const history = new History(0);
  for (const state of [1, 12, 125]) history.push(state, "strength");
  history.push(9, "radius");
  history.undo();
  assert.equal(history.present, 125);
  history.undo();
  assert.equal(history.present, 0);
});

test("the history is bounded", () => {
  const history = new History(0, 3);
  for (let state = 1; state < 10; state++) history.push(state);
  while (history.undo());
  assert.equal(history.present, 6);
});

test("the pressure of a pen becomes factors on the strength along the path", () => {
  const document = emptyDocument(1000, 500);
  const stroke = newStroke(document, "wind", [[0, 0], [100, 0], [200, 0]], [0.25, 0.5, 1]);
  assert.deepEqual(stroke.strength_keys, [[0, 0.5], [0.5, 1], [1, 2]]);
  assert.equal(newStroke(document, "wind", [[0, 0], [1, 0]]).strength_keys, undefined);
});

test("a led point keeps the timing of the hand", () => {
  const lead = newLead(emptyDocument(1000, 500), [[0, 0], [10, 0], [30, 0]], [5, 5.5, 6]);
  assert.deepEqual(lead.motion.points, [[0, 0], [10, 0], [30, 0]]);
  const [first, second, third] = lead.motion.times;
  assert.equal(first, 0);
  assert.ok(Math.abs(second - 0.5) < 0.01 && Math.abs(third - 1) < 0.01);
  const quick = newLead(emptyDocument(1000, 500), [[0, 0], [1, 0], [2, 0]], [0, 0, 0]);
  assert.ok(quick.motion.times.every((time, i, all) => !i || time - all[i - 1] >= 0.001));
});

test("a wave swings to where it was dragged", () => {
  const { motion, position } = newWave(emptyDocument(1000, 500), [100, 100], [100, 140]);
  assert.deepEqual(position, [100, 100]);
  assert.deepEqual([motion.amplitude, motion.direction], [40, [0, 1]]);
});

test("a picture of another size takes the scene along, as the simulation would", () => {
  const document = {
    version: 2, width: 100, height: 50,
    strokes: [{ path: [[10, 10], [20, 20]], radius: 10, speed: 100, strength: 2 }],
    query_points: [{ x: 5, y: 5, positive: false }],
    wind: { origin: [10, 20] },
    rig_points: [
      { position: [10, 10] },
      { position: [50, 25], region: { type: "polygon", points: [[1, 1], [2, 1], [1, 2]] }, motion: { type: "wave", amplitude: 10, direction: [0, 2] } },
    ],
  };
  const larger = rescaled(document, 200, 150);
  assert.deepEqual(larger.strokes[0], { path: [[20, 30], [40, 60]], radius: 20, speed: 200, strength: 2 });
  assert.deepEqual(larger.rig_points[0], { position: [20, 30], region: { type: "circle", radius: 40 } });
  assert.deepEqual(larger.rig_points[1].region.points, [[2, 3], [4, 3], [2, 6]]);
  assert.equal(larger.rig_points[1].motion.amplitude, 30);
  assert.deepEqual(larger.query_points, [{ x: 10, y: 15, positive: false }]);
  assert.deepEqual(larger.wind, { origin: [20, 60], turbulence_size: 400 });
  assert.equal(rescaled(document, 100, 50), document);
});

test("the timeline knows when strokes act", () => {
  const reference = { list: "strokes", index: 0 };
  const gusts = { path: [[0, 0], [100, 0]], speed: 200, start: 0.5, interval: 1, end: 2.5 };
  assert.deepEqual(departures(gusts, 3), [0.5, 1.5]);
  assert.deepEqual(spansOf(reference, gusts, 3), [[0.5, 1], [1.5, 2]]);
  assert.deepEqual(spansOf(reference, { ...gusts, interval: 0.1 }, 3), [[0.5, 3]]);
  assert.deepEqual(spansOf(reference, { ...gusts, end: 0.7, interval: 0.1, repeat: 1.5 }, 3), [[0.5, 1.2], [2, 2.7]]);
  assert.deepEqual(spansOf({ list: "rig_points", index: 0 }, { motion: { type: "path", times: [1, 2] } }, 3), [[1, 2]]);
});

test("items are called what they are", () => {
  assert.equal(titleOf({ list: "strokes", index: 0 }, { kind: "repel" }), "Repel stroke 1");
  assert.equal(titleOf({ list: "rig_points", index: 2 }, {}), "Pin 3");
  assert.equal(titleOf({ list: "rig_points", index: 0 }, { motion: { type: "wave" } }), "Wave 1");
});

test("what acts begins and ends where its lane is dragged to", () => {
  const stroke = { list: "strokes", index: 0 };
  const wind = { kind: "wind", path: [[0, 0], [9, 0]] };
  assert.deepEqual(edgesOf(stroke, wind, 3), [["start", 0], ["end", 3]]);
  const late = withEdge(stroke, wind, "start", 1.234, 3);
  assert.equal(late.start, 1.23);
  const short = withEdge(stroke, late, "end", 2, 3);
  assert.equal(short.end, 2);
  assert.equal(withEdge(stroke, short, "start", 2.5, 3).start, 1.95);
  assert.equal(withEdge(stroke, short, "end", 0.3, 3).end, 1.28);
  assert.equal("end" in withEdge(stroke, short, "end", 3.1, 3), false);
  const point = { list: "rig_points", index: 0 };
  const led = { position: [0, 0], motion: { type: "path", points: [[0, 0], [1, 0], [2, 0]], times: [0, 1, 2] } };
  assert.deepEqual(edgesOf(point, led, 3), [["start", 0], ["end", 2]]);
  assert.deepEqual(withEdge(point, led, "end", 1, 3).motion.times, [0, 0.5, 1]);
  assert.deepEqual(withEdge(point, led, "start", 1, 3).motion.times, [1, 1.5, 2]);
  assert.deepEqual(edgesOf(point, { position: [0, 0], motion: { type: "pinned" } }, 3), []);
  assert.deepEqual(edgesOf({ list: "paint", index: 0 }, { region: {} }, 3), []);
});
