import assert from "node:assert/strict";
import { test } from "node:test";
import { partCount, pointsOn, presetOf, withoutPart, withPartPreset } from "../../nodes/web/js/scene/parts.js";
import { animatedPicture, picksOfAnimation, sourceOf } from "../../nodes/web/js/host/attach_picks.js";

const POINTS = [{ x: 1, y: 1, positive: true }, { x: 2, y: 2, positive: false, part: 1 }, { x: 3, y: 3, positive: true, part: 2 }];
const DOCUMENT = { version: 2, width: 9, height: 9, query_points: POINTS, bodies: [{}, { material: { preset: "cloth" } }, { material: { preset: "leaf" } }] };

test("parts are counted by their points and the one that is being picked", () => {
  assert.equal(partCount({ ...DOCUMENT, query_points: [] }), 1);
  assert.equal(partCount(DOCUMENT), 3);
  assert.equal(partCount(DOCUMENT, 3), 4);
  assert.deepEqual([0, 1, 2].map((part) => pointsOn(DOCUMENT, part)), [1, 0, 1]);
});

test("a part that goes away takes its points and its preset along, and those after it move up", () => {
  const left = withoutPart(DOCUMENT, 0);
  assert.deepEqual(left.query_points, [{ x: 2, y: 2, positive: false }, { x: 3, y: 3, positive: true, part: 1 }]);
  assert.deepEqual([0, 1].map((part) => presetOf(left, part)), ["cloth", "leaf"]);
  assert.equal(DOCUMENT.query_points.length, 3);
});

test("a preset of a part stands in the document's bodies, and can be taken back", () => {
  const made = withPartPreset({ version: 2, query_points: POINTS, sizeless: true }, 1, "hair");
  assert.deepEqual(made.bodies, [{}, { material: { preset: "hair" } }]);
  assert.equal(made.sizeless, undefined);
  assert.equal(presetOf(withPartPreset(made, 1, ""), 1), "");
});

test("the server is told which file a picture is", () => {
  assert.deepEqual(sourceOf("/view?filename=a.png&subfolder=x&type=input", true), { picture: "x/a.png", alpha: true });
  assert.deepEqual(sourceOf("/view?filename=a.png&subfolder=&type=temp", false), { picture: "a.png [temp]", alpha: false });
  assert.deepEqual(sourceOf("/physanimator/example", true), { picture: null, alpha: false });
  assert.equal(sourceOf("blob:x", false), null);
  assert.equal(sourceOf(null, false), null);
});

test("a file that the server cannot read as a picture is not uploaded, whatever the browser calls it", async () => {
  const told = [];
  const app = { extensionManager: { toast: { add: (toast) => told.push(toast.detail) } } };
  const api = { fetchApi: () => assert.fail("nothing is sent") };
  globalThis.document = { createElement: () => new EventTarget() };
  picksOfAnimation(app, api, { widgets: [] }).takePicture({ name: "girl.svg", type: "image/svg+xml" });
  await Promise.resolve();
  delete globalThis.document;
  assert.deepEqual(told, ["Choose a picture, or a .psd, .psb or .ora file."]);
});

test("a layered file is shown flat, and its layers can be picked, from a node that loads it as well", () => {
  const path = animatedPicture({ inputs: [], widgets: [{ name: "picture", value: "a b/girl.psd" }] }, {});
  assert.equal(path, "/physanimator/artwork?file=a+b%2Fgirl.psd");
  assert.deepEqual(sourceOf(path, true), { picture: "a b/girl.psd", alpha: true, layered: true });
  const loader = { comfyClass: "PhysAnimator_LoadLayers", mode: 0, widgets: [{ name: "file", value: "girl.ora" }] };
  const node = { inputs: [{ name: "layers", link: 1 }], isInputConnected: () => true, getInputLink: () => ({ origin_id: 7 }), graph: { getNodeById: () => loader } };
  assert.equal(animatedPicture(node, {}), "/physanimator/artwork?file=girl.ora");
  loader.mode = 4;
  assert.equal(animatedPicture({ ...node, physanimatorSeen: "/view?filename=a.png" }, {}), "/view?filename=a.png");
});
