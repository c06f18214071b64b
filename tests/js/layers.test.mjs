import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { layerAt } from "../../nodes/web/js/preview/layered_picture.js";
import { SIDES, withAttach, withFoundHolds, withHoldsAnew, withLostHolds } from "../../nodes/web/js/scene/holds.js";
import { History } from "../../nodes/web/js/scene/history.js";
import { attachIn, bodyOf, inOrder, isAsRun, movesIn, presetIn, PRESETS, withMoves, withNames, withPlace, withPreset } from "../../nodes/web/js/scene/layers.js";

const layer = (index, name, moves, more = {}) => ({ index, name, shown: true, moves, moving: moves, preset: "hair", attach: "head", ...more });
const FACE = layer(2, "face", false);
const FRONT = layer(3, "前髪", true);
const TAIL = layer(1, "tail", true, { preset: "ribbon" });
const HIDDEN = layer(0, "sketch", false, { shown: false });
const LAYERS = [FRONT, FACE, TAIL, HIDDEN];
const EMPTY = { version: 2, width: 100, height: 80 };
const pin = (body) => ({ position: [1, 2], region: { type: "circle", radius: 3 }, ...(body === undefined ? {} : { body }) });

test("without a document's word layers move as the node says", () => {
  assert.deepEqual(LAYERS.map((one) => movesIn(EMPTY, one)), [true, false, true, false]);
  assert.equal(isAsRun(EMPTY, LAYERS), true);
});

test("what moves gets named bodies from back to front, so that their numbers hold", () => {
  const named = withNames({ ...EMPTY, rig_points: [pin(1)] }, LAYERS);
  assert.deepEqual(named.bodies, [{ name: "tail" }, { name: "前髪" }]);
  assert.deepEqual(named.rig_points, [pin(1)]);
  assert.equal(withNames(named, LAYERS), named);
});

test("bodies without a name get the names in order and keep their values", () => {
  const named = withNames({ ...EMPTY, bodies: [{ material: { preset: "leaf" } }] }, LAYERS);
  assert.deepEqual(named.bodies, [{ material: { preset: "leaf" }, name: "tail" }, { name: "前髪" }]);
  assert.equal(presetIn(named, TAIL), "leaf");
});

test("a layer that is switched off takes its own pins along, the others keep to their bodies", () => {
  const document = { ...EMPTY, rig_points: [pin(0), pin(1), pin()], paint: [{ body: 0 }, { body: 1 }] };
  const off = withMoves(document, TAIL, false, LAYERS);
  assert.deepEqual(off.bodies, [{ name: "前髪" }]);
  assert.deepEqual(off.still, ["tail"]);
  assert.deepEqual(off.rig_points, [pin(0), pin()]);
  assert.deepEqual(off.paint, [{ body: 0 }]);
  assert.equal(movesIn(off, TAIL), false);
  assert.equal(isAsRun(off, LAYERS), false);
  const on = withMoves(off, TAIL, true, LAYERS);
  assert.equal("still" in on, false);
  assert.deepEqual(on.bodies.at(-1), { name: "tail", material: { preset: "ribbon" }, attach: "head" });
  assert.deepEqual(on.rig_points, [pin(0), pin()]);
});

test("a layer that its name does not move is added and taken away without a trace", () => {
  const on = withMoves(withNames(EMPTY, LAYERS), FACE, true, LAYERS);
  assert.equal(bodyOf(on, "face"), 2);
  const off = withMoves(on, FACE, false, LAYERS);
  assert.deepEqual(off, withNames(EMPTY, LAYERS));
  assert.equal(withMoves(EMPTY, HIDDEN, false, LAYERS), EMPTY);
});

test("switching is a step to undo", () => {
  const history = new History(EMPTY);
  history.push(withMoves(EMPTY, TAIL, false, LAYERS));
  history.undo();
  assert.equal(movesIn(history.present, TAIL), true);
});

test("another preset takes the place of the material", () => {
  const made = withPreset({ ...EMPTY, bodies: [{ name: "tail", material: { youngs_modulus: 3 } }] }, TAIL, "cloth", LAYERS);
  assert.deepEqual(made.bodies[0], { name: "tail", material: { preset: "cloth" } });
  assert.equal(presetIn(made, TAIL), "cloth");
});

test("presets are those of the schema", () => {
  const schema = JSON.parse(readFileSync(new URL("../../physics/document/scene.schema.json", import.meta.url), "utf8"));
  assert.deepEqual(PRESETS, schema.$defs.material.properties.preset.enum);
});

test("the frontmost layer that moves is found, where it is at this moment", () => {
  const square = (x, y) => [x, y, x + 10, y, x, y + 10, x + 10, y + 10];
  const mesh = {
    positions: new Float32Array([...square(0, 0), ...square(5, 5)]),
    triangles: new Uint32Array([0, 1, 2, 1, 3, 2, 4, 5, 6, 5, 7, 6]),
    bodies: new Uint32Array([0, 2, 2, 4]),
  };
  const layers = [{ layer: 4, body: 0 }, { layer: 6, body: null }, { layer: 9, body: 1 }];
  const at = (point, unseen = [], moved = null) => layerAt(mesh, layers, new Set(unseen), point, moved, 0.5);
  assert.equal(at([7, 7]), 9);
  assert.equal(at([7, 7], [9]), 4);
  assert.equal(at([2, 2]), 4);
  assert.equal(at([40, 2]), null);
  assert.equal(at([107, 7], [], new Int16Array(16).fill(0).map((_, i) => (i % 2 ? 0 : 200))), 9);
});

const names = (layers) => layers.map((one) => one.name);
const hold = (name, body, ...points) => ({ name, body, points });
const HELD = { position: [5, 5], region: { type: "polygon", points: [[0, 0], [9, 0], [9, 9]] } };
const HOLDS = [hold("tail", 0, HELD), hold("前髪", 1, HELD, HELD)];

test("sides are those of the schema", () => {
  const schema = JSON.parse(readFileSync(new URL("../../physics/document/scene.schema.json", import.meta.url), "utf8"));
  assert.deepEqual(Object.keys(SIDES), schema.$defs.body.properties.attach.enum);
});

test("layers change places, and those that the document does not name stay", () => {
  assert.deepEqual(names(inOrder(EMPTY, LAYERS)), ["前髪", "face", "tail", "sketch"]);
  const behind = withPlace(EMPTY, FRONT, -1, LAYERS);
  assert.deepEqual(behind.order, ["sketch", "tail", "前髪", "face"]);
  assert.deepEqual(names(inOrder(behind, LAYERS)), ["face", "前髪", "tail", "sketch"]);
  assert.equal(withPlace(EMPTY, FRONT, 3, LAYERS), EMPTY);
  assert.deepEqual(names(inOrder({ ...EMPTY, order: ["前髪", "gone", "tail"] }, LAYERS)), ["tail", "face", "前髪", "sketch"]);
});

test("a picture is held from the start by the pins that its run has found", () => {
  const held = withFoundHolds({ ...EMPTY, strokes: [{ kind: "wind" }] }, HOLDS, LAYERS);
  assert.deepEqual(held.rig_points.map((one) => one.body), [0, 1, 1]);
  assert.deepEqual(held.bodies, [{ name: "tail" }, { name: "前髪" }]);
  assert.equal(withFoundHolds(held, HOLDS, LAYERS), held);
});

test("pins that somebody has taken away stay away, and a layer that comes later is held", () => {
  const bare = { ...EMPTY, rig_points: [], bodies: [{ name: "tail" }] };
  const held = withFoundHolds(bare, HOLDS, LAYERS);
  assert.deepEqual(held.rig_points.map((one) => one.body), [1, 1]);
});

test("pins drawn before come last, so that they lead", () => {
  const drawn = { ...EMPTY, rig_points: [pin()] };
  assert.deepEqual(withFoundHolds(drawn, HOLDS, LAYERS).rig_points.at(-1), pin());
});

test("another side takes the place of the pins of that layer, but not of what leads it about", () => {
  const led = { ...pin(0), motion: { type: "wave" } };
  const document = { ...EMPTY, bodies: [{ name: "tail" }, { name: "前髪" }], rig_points: [pin(0), led, pin(1), pin()] };
  const made = withAttach(document, TAIL, "bottom", [HELD], LAYERS);
  assert.equal(attachIn(made, TAIL), "bottom");
  assert.deepEqual(made.rig_points, [{ ...HELD, body: 0 }, led, pin(1), pin()]);
  assert.equal(attachIn(document, TAIL), "head");
});

test("all holds are put back at once", () => {
  const document = { ...EMPTY, bodies: [{ name: "tail" }, { name: "前髪" }], rig_points: [pin(0), pin()] };
  assert.deepEqual(withHoldsAnew(document, HOLDS, LAYERS).rig_points.map((one) => one.body), [0, 1, 1, undefined]);
  const flat = withHoldsAnew({ ...EMPTY, rig_points: [pin(0)] }, [hold("", 0, HELD)], []);
  assert.deepEqual(flat.rig_points, [{ ...HELD, body: 0 }]);
});

test("who loses the last pin is held nowhere until somebody says otherwise", () => {
  const before = { ...EMPTY, bodies: [{ name: "tail", attach: "top" }], rig_points: [pin(0)] };
  const after = withLostHolds({ ...before, rig_points: [] }, before);
  assert.equal(after.bodies[0].attach, "none");
  assert.equal(withFoundHolds(after, HOLDS.slice(0, 1), LAYERS), after);
  const other = withAttach(before, TAIL, "left", null, LAYERS);
  assert.equal(withLostHolds(other, before), other);
});
