import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import test from "node:test";
import { ALL_FIELDS, fieldsOf, newMotion } from "../../nodes/web/js/scene/fields.js";
import { POINTS } from "../../nodes/web/js/host/formats.js";
import { executionId } from "../../nodes/web/js/host/queueing.js";
import { upstreamPicture } from "../../nodes/web/js/host/upstream.js";
import { ACTIONS, POINT_GROUPS, SCENE_GROUPS } from "../../nodes/web/js/panels/toolbar.js";
import { Scheduler } from "../../nodes/web/js/stage/scheduler.js";

const schema = JSON.parse(readFileSync(new URL("../../physics/document/scene.schema.json", import.meta.url), "utf8"));

function described(place) {
  const [holder, name] = place.split(".");
  const entry = (holder === "scene" ? schema : schema.$defs[holder]).properties[name];
  assert.ok(entry, `the schema has no ${place}`);
  return entry;
}

test("every field is in the schema, with its default, choices and bounds", () => {
  const known = ALL_FIELDS.filter((field) => field.schema);
  assert.ok(known.length > 40);
  for (const field of known) {
    const entry = described(field.schema);
    const name = field.schema;
    if ("default" in entry && field.default !== undefined) assert.deepEqual(entry.default, field.default, name);
    if (field.optional) assert.ok([].concat(entry.type).includes("null"), `${name} cannot be left out`);
    if (field.choices) assert.deepEqual(entry.enum, field.choices, name);
    const numbers = field.kind === "pair" ? entry.items : entry;
    const least = numbers.minimum ?? numbers.exclusiveMinimum;
    const most = numbers.maximum ?? numbers.exclusiveMaximum;
    if (field.min !== undefined) assert.ok(field.min >= least && (numbers.minimum !== undefined || field.min > least), name);
    if (field.max !== undefined) assert.ok(field.max <= most, name);
  }
});

test("fields carry the unit that the schema names", () => {
  const units = { "side/s^2": "side/s²" };
  for (const field of ALL_FIELDS.filter((one) => one.schema && one.kind === "number" && one.unit && one.unit !== "×")) {
    const [, unit] = described(field.schema).title.match(/\[(.+)\]$/);
    assert.equal(field.unit, units[unit] ?? unit, field.schema);
  }
});

test("each kind of item has its own fields, and each motion can be chosen", () => {
  const paths = (item) => fieldsOf({ list: "rig_points", index: 0 }, item).map((field) => field.path);
  assert.ok(paths({ motion: { type: "wave" } }).includes("motion.amplitude"));
  assert.ok(!paths({ region: { type: "polygon" } }).includes("region.radius"));
  assert.ok(!paths({ motion: { type: "combined" } }).includes("motion.type"));
  for (const type of ["pinned", "path", "wave", "rotation", "swing", "squash", "pulse"]) {
    const motion = newMotion({ position: [1, 2] }, type);
    assert.equal(motion.type, type);
    for (const needed of schema.$defs[type].required ?? []) assert.ok(needed in motion, `${type}.${needed}`);
  }
});

test("every button has an action, and no key is given twice", () => {
  for (const id of [...SCENE_GROUPS, ...POINT_GROUPS].flat()) assert.ok(ACTIONS[id], id);
  const keys = Object.values(ACTIONS).map((action) => action.key);
  assert.equal(new Set(keys).size, keys.length);
});

test("points are read in every form that the node takes, and written as a scene document", () => {
  const listed = POINTS.read("[[640, 360, 1], [3, 4, 0]]");
  assert.deepEqual(listed.query_points, [{ x: 640, y: 360, positive: true }, { x: 3, y: 4, positive: false }]);
  assert.equal(POINTS.write(listed), "[[640,360,1],[3,4,0]]");
  const grouped = POINTS.read('{"positive": [[1, 2]], "negative": [{"x": 3, "y": 4}]}');
  assert.deepEqual(grouped.query_points.map((point) => point.positive), [true, false]);
  const document = POINTS.read('{"version": 2, "width": 9, "height": 8, "query_points": [{"x": 1, "y": 2}]}');
  assert.deepEqual(JSON.parse(POINTS.write(document)), { version: 2, width: 9, height: 8, query_points: [{ x: 1, y: 2 }] });
  assert.throws(() => POINTS.read("12 13"), /not JSON/);
  assert.deepEqual(POINTS.read("").query_points, []);
});

function graphOf(nodes, links) {
  const graph = { nodes, links, getNodeById: (id) => nodes.find((node) => node.id === id) };
  for (const node of nodes) {
    node.isInputConnected = (slot) => node.inputs[slot]?.to != null;
    node.getInputLink = (slot) => links[node.inputs[slot]?.to] ?? null;
  }
  for (const node of nodes) node.graph = graph;
  return graph;
}

const load = { id: 1, type: "LoadImage", widgets: [{ name: "image", value: "art/girl.png [output]" }], inputs: [] };

test("the picture is found through other nodes and out of subgraphs", () => {
  const scale = { id: 2, type: "ImageScale", inputs: [{ type: "IMAGE", to: 10 }] };
  const inner = { id: 5, type: "PhysAnimator_SceneEditor", inputs: [{ type: "PHYSANIMATOR_BODIES", to: null }, { type: "IMAGE", to: 20 }] };
  const subgraph = graphOf([inner], { 20: { origin_id: -10, origin_slot: 0 } });
  const holder = { id: 3, type: "sub", subgraph, inputs: [{ type: "IMAGE", to: 11 }] };
  const root = graphOf([load, scale, holder], { 10: { origin_id: 1 }, 11: { origin_id: 2 } });
  assert.equal(upstreamPicture(inner, root), "/view?filename=girl.png&subfolder=art&type=output");
  assert.equal(executionId(inner, root), "3:5");
  assert.equal(executionId(scale, root), "2");
});

test("a file from the input folder and the pack's own example are pictures, a bypassed node's is none", () => {
  const found = (source) => {
    const editor = { id: 2, type: "PhysAnimator_SceneEditor", inputs: [{ type: "IMAGE", to: 10 }] };
    return upstreamPicture(editor, graphOf([{ id: 1, inputs: [], ...source }, editor], { 10: { origin_id: 1 } }));
  };
  const widgets = [{ name: "image", value: "girl.png" }];
  assert.equal(found({ type: "LoadImage", widgets }), "/view?filename=girl.png&subfolder=&type=input");
  assert.equal(found({ type: "LoadImage", widgets, mode: 4 }), null);
  assert.equal(found({ type: "PhysAnimator_ExampleIllustration" }), "/physanimator/example");
});

test("a node that left its graph has no picture, and its frontend is not asked", () => {
  const first = { id: 1, type: "A", inputs: [{ type: "IMAGE", to: 1 }] };
  const second = { id: 2, type: "B", inputs: [{ type: "IMAGE", to: 2 }] };
  const root = graphOf([first, second], { 1: { origin_id: 2 }, 2: { origin_id: 1 } });
  second.graph = undefined;
  second.getInputLink = () => {
    throw new TypeError("Cannot read properties of undefined (reading 'getLinks')");
  };
  assert.equal(upstreamPicture(first, root), null);
});

test("a node that holds a subgraph is asked for the link at its outer end", () => {
  const inner = { id: 5, type: "PhysAnimator_SceneEditor", inputs: [{ type: "IMAGE", to: 20 }] };
  const subgraph = graphOf([inner], { 20: { origin_id: -10, origin_slot: 0 } });
  const holder = { id: 3, type: "sub", subgraph, inputs: [{ type: "IMAGE", to: 11 }] };
  const root = graphOf([load, holder], { 11: { origin_id: 1 } });
  const { getInputLink } = holder;
  holder.getInputLink = () => {
    throw new TypeError("Cannot read properties of undefined (reading 'getLinks')");
  };
  globalThis.LiteGraph = { LGraphNode: { prototype: { getInputLink } } };
  try {
    assert.equal(upstreamPicture(inner, root), "/view?filename=girl.png&subfolder=art&type=output");
  } finally {
    delete globalThis.LiteGraph;
  }
});

test("a ring of links ends, and a node without a picture has none", () => {
  const first = { id: 1, type: "A", inputs: [{ type: "IMAGE", to: 1 }] };
  const second = { id: 2, type: "B", inputs: [{ type: "IMAGE", to: 2 }] };
  const root = graphOf([first, second], { 1: { origin_id: 2 }, 2: { origin_id: 1 } });
  assert.equal(upstreamPicture(first, root), null);
});

test("however often it is asked to, it draws once a frame", () => {
  const frames = [];
  let drawn = 0;
  const scheduler = new Scheduler(() => ++drawn < 3 && false, (callback) => frames.push(callback));
  for (let k = 0; k < 100; k++) scheduler.request();
  assert.equal(frames.length, 1);
  frames.pop()(0);
  assert.equal(drawn, 1);
  scheduler.request();
  scheduler.stop();
  frames.pop()(0);
  assert.equal(drawn, 1);
});

test("only one module registers something with the host", () => {
  const root = new URL("../../nodes/web/js/", import.meta.url);
  const modules = readdirSync(root, { recursive: true }).filter((name) => name.endsWith(".js"));
  const registering = modules.filter((name) => /registerExtension|scripts\/app\.js/.test(readFileSync(new URL(name, root), "utf8")));
  assert.deepEqual(registering, ["physanimator.js"]);
  for (const name of modules) {
    const text = readFileSync(new URL(name, root), "utf8");
    assert.doesNotMatch(text, /\beval\(|new Function|document\.body|document\.addEventListener|window\./, name);
  }
});
