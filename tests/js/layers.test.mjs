import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { layerAt } from "../../nodes/web/js/preview/layered_picture.js";
import { bodyOf, isAsRun, movesIn, presetIn, PRESETS, withMoves, withNames, withPreset } from "../../nodes/web/js/scene/layers.js";
import { History } from "../../nodes/web/js/scene/history.js";

const layer = (index, name, moves, more = {}) => ({ index, name, shown: true, moves, moving: moves, preset: "hair", ...more });
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
  assert.deepEqual(on.bodies.at(-1), { name: "tail", material: { preset: "ribbon" } });
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
