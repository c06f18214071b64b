import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { lameOf, MATERIAL_FIELDS, materialFields, stiffnessOf, targetsOf, wholeOf, withMaterial, writtenOf, youngOf } from "../../nodes/web/js/scene/materials.js";

const schema = JSON.parse(readFileSync(new URL("../../physics/document/scene.schema.json", import.meta.url), "utf8")).$defs.material.properties;
const PLAIN = Object.fromEntries(Object.entries(schema).filter(([, entry]) => (entry.default ?? null) !== null).map(([name, entry]) => [name, entry.default]));
const HAIR = { ...PLAIN, youngs_modulus: 400, damping: 1, sway_frequency: 0.7, stretch_limit: 1.06, root_stiffness: 30, name: "hair" };
const JELLY = { ...PLAIN, youngs_modulus: 40, poisson_ratio: 0.45, sway_frequency: 1.5, name: "jelly" };
const bodies = [{ name: "", material: { preset: "hair" } }, { name: "", material: { ...PLAIN, youngs_modulus: 80 } }];
const MATERIALS = { presets: { hair: HAIR, jelly: JELLY }, plain: PLAIN, bodies, order: [0, 1] };
const EMPTY = { version: 2, width: 100, height: 80 };
const [FRONT, BACK] = targetsOf(EMPTY, MATERIALS, []);
const made = (document, target, ...changes) => withMaterial(document, target, changes, MATERIALS, []);

test("every field of a material is in the schema, within its bounds", () => {
  assert.ok(MATERIAL_FIELDS.length >= 11);
  for (const field of MATERIAL_FIELDS) {
    const entry = schema[field.path];
    assert.ok(entry, field.path);
    if (field.default !== undefined) assert.equal(field.default, entry.default, field.path);
    if (field.optional) assert.ok([].concat(entry.type).includes("null"), field.path);
    const least = entry.minimum ?? entry.exclusiveMinimum;
    assert.ok(field.min >= least && (entry.minimum !== undefined || field.min > least), field.path);
    assert.ok(field.max <= (entry.maximum ?? entry.exclusiveMaximum), field.path);
    const unit = entry.title.match(/\[(.+)\]$/)?.[1]?.replace("side^2/s^2", "side²/s²") ?? "";
    assert.equal(field.unit.replace("×", ""), unit, field.path);
  }
});

test("bodies come from front to back, with the material that they had", () => {
  assert.deepEqual([FRONT.number, BACK.number], [1, 0]);
  assert.equal(writtenOf(EMPTY, FRONT).youngs_modulus, 80);
  assert.equal(stiffnessOf(wholeOf(writtenOf(EMPTY, BACK), MATERIALS)), "sway");
  assert.deepEqual(targetsOf(EMPTY, null, []), []);
});

test("a value that is changed makes an entry for the body and leaves all else", () => {
  const changed = made({ ...EMPTY, strokes: [{}] }, FRONT, ["damping", 3]);
  assert.deepEqual(changed.bodies, [{}, { material: { ...PLAIN, youngs_modulus: 80, damping: 3 } }]);
  assert.deepEqual(changed.strokes, [{}]);
  const preset = made(EMPTY, BACK, ["damping", 3]);
  assert.deepEqual(preset.bodies, [{ material: { preset: "hair", damping: 3 } }]);
});

test("the same stiffness is told as Lame parameters and back", () => {
  assert.deepEqual(lameOf(520, 0.3), [200, 300]);
  assert.deepEqual(youngOf(200, 300), [520, 0.3]);
  assert.deepEqual(lameOf(10, 0), [5, 0]);
  assert.deepEqual(youngOf(5, 0), [10, 0]);
  const lame = made(EMPTY, FRONT, ["stiffness", "Lame"]);
  const { material } = lame.bodies[1];
  assert.deepEqual([material.mu, material.lambda], lameOf(80, 0.3));
  assert.ok(!("youngs_modulus" in material) && !("poisson_ratio" in material) && !("sway_frequency" in material));
  const back = made(lame, FRONT, ["stiffness", "Young"]).bodies[1].material;
  assert.deepEqual([back.youngs_modulus, back.poisson_ratio], [80, 0.3]);
  assert.ok(!("mu" in back) && !("lambda" in back));
});

test("a preset that sways gives way to Lame parameters, and says no sway beside Young's modulus", () => {
  const lame = made(EMPTY, BACK, ["stiffness", "Lame"]).bodies[0].material;
  assert.deepEqual(Object.keys(lame).sort(), ["lambda", "mu", "preset"]);
  assert.equal(stiffnessOf(wholeOf(lame, MATERIALS)), "Lame");
  const young = made(EMPTY, BACK, ["stiffness", "Young"]).bodies[0].material;
  assert.deepEqual(young, { preset: "hair", youngs_modulus: 400, poisson_ratio: 0.3, sway_frequency: null });
  assert.equal(stiffnessOf(wholeOf(young, MATERIALS)), "Young");
  const swaying = withMaterial(EMPTY, BACK, [["stiffness", "Lame"]], MATERIALS, [], 5200).bodies[0].material;
  assert.deepEqual([swaying.mu, swaying.lambda], [2000, 3000]);
  assert.equal(made({ ...EMPTY, bodies: [{ material: young }] }, BACK, ["stiffness", "sway"]).bodies[0].material.sway_frequency, 0.7);
});

test("a limit that is emptied is none, also against a preset", () => {
  assert.deepEqual(made(EMPTY, BACK, ["stretch_limit", undefined]).bodies[0].material, { preset: "hair", stretch_limit: null });
  assert.ok(!("stretch_limit" in made(EMPTY, FRONT, ["stretch_limit", undefined]).bodies[1].material));
});

test("another preset replaces all, and the fields are those of what says how stiff it is", () => {
  const jelly = made(made(EMPTY, FRONT, ["density", 4]), FRONT, ["preset", "jelly"]);
  assert.deepEqual(jelly.bodies[1], { material: { preset: "jelly" } });
  const paths = (written) => materialFields(MATERIALS, written).map((field) => field.path);
  assert.ok(paths({ preset: "hair" }).includes("sway_frequency"));
  assert.ok(paths({ mu: 1, lambda: 0 }).includes("lambda"));
  assert.ok(!paths({ mu: 1, lambda: 0 }).includes("youngs_modulus"));
  const steps = materialFields(MATERIALS, { mu: 0.065, lambda: 0 }).filter((field) => ["mu", "lambda"].includes(field.path));
  assert.deepEqual(steps.map((field) => field.step), [0.001, 0.001]);
});

test("layers keep their materials by name", () => {
  const layer = (index, name) => ({ index, name, shown: true, moves: true, moving: true, preset: "hair", attach: "auto" });
  const layers = [layer(1, "front"), layer(0, "tail")];
  const named = { ...MATERIALS, bodies: [{ name: "tail", material: { preset: "jelly" } }, { name: "front", material: { preset: "hair" } }] };
  const targets = targetsOf(EMPTY, named, layers);
  assert.deepEqual(targets.map((target) => target.material.preset), ["hair", "jelly"]);
  const changed = withMaterial(EMPTY, targets[0], [["density", 2]], named, layers);
  assert.deepEqual(changed.bodies, [{ name: "tail" }, { name: "front", material: { preset: "hair", density: 2 } }]);
});
