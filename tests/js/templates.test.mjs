import assert from "node:assert/strict";
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

import { TAGS } from "../../nodes/web/js/host/template_tags.js";
import { folderOf, offered, presentTemplates, TEMPLATES } from "../../nodes/web/js/host/templates.js";

const FOLDER = new URL("../../workflows/", import.meta.url);
const FILES = readdirSync(FOLDER).filter((name) => name.endsWith(".json")).map((name) => name.slice(0, -5));
const read = (name) => JSON.parse(readFileSync(new URL(`${name}.json`, FOLDER), "utf8"));

test("every workflow is described, the quickstart first, and has both thumbnails", () => {
  assert.deepEqual(TEMPLATES.map(({ name }) => name).sort(), [...FILES].sort());
  assert.equal(TEMPLATES[0].name, "quickstart");
  for (const name of FILES) {
    assert.ok(existsSync(new URL(`${name}.jpg`, FOLDER)), name);
    assert.ok(existsSync(new URL(`${name}.webp`, FOLDER)), name);
  }
});

test("titles and descriptions differ, and are not file names", () => {
  for (const key of ["title", "description"]) {
    assert.equal(new Set(TEMPLATES.map((one) => one[key])).size, TEMPLATES.length);
    for (const one of TEMPLATES) assert.ok(!/_/.test(one[key]), one[key]);
  }
});

/** Called the same in every language. */
const NAMES = /^(psd|svd|lvcd|sam|lama|gif|live2d|wan|vace|ttm|ltx|ic-lora|anisora|tooncrafter|time-to-move|dual-clock|(stable|differential) diffusion)$/;

test("tags are translated, or names", () => {
  const tags = new Set(TEMPLATES.flatMap((one) => one.tags));
  assert.deepEqual([...tags].filter((tag) => !TAGS.includes(tag) && !NAMES.test(tag)), []);
  assert.deepEqual(TAGS.filter((tag) => !tags.has(tag)), []);
});

test("what a workflow needs is in it", () => {
  for (const { name, needs = [] } of TEMPLATES) {
    const types = new Set(read(name).nodes.map((node) => node.type));
    for (const type of needs) assert.ok(types.has(type), `${name}: ${type}`);
  }
});

test("a workflow that cannot run is not offered, and one that nobody described is, at the end", () => {
  const types = Object.fromEntries(["WanVaceToVideo"].map((type) => [type, {}]));
  const names = offered(["zebra", "wan_vace", "see_through", "quickstart"], types).map(({ name }) => name);
  assert.deepEqual(names, ["quickstart", "wan_vace", "zebra"]);
  assert.equal(offered(FILES, null).length, FILES.length);
});

/** A host whose list of a language that it lacks asks for the English one, as the real one does. */
function hostApi(folder) {
  return {
    async getWorkflowTemplates() {
      return { [folder]: ["quickstart", "contact"], other: ["theirs"] };
    },
    async getCoreWorkflowTemplates(locale) {
      return locale && locale !== "en" ? this.getCoreWorkflowTemplates() : [{ moduleName: "default", templates: [] }];
    },
  };
}

test("the host lists them as a group with titles, found by the pack's name, once", async () => {
  const api = hostApi("");
  presentTemplates(api);
  assert.deepEqual(await api.getWorkflowTemplates(), { other: ["theirs"] });
  const groups = await api.getCoreWorkflowTemplates("ja");
  assert.deepEqual(groups.map((group) => group.moduleName), ["default", ""]);
  const [first] = groups[1].templates;
  assert.equal(first.name, "quickstart");
  assert.ok(first.tags.includes("PhysAnimator"));
  assert.equal("needs" in first, false);
  assert.equal(folderOf("http://host/extensions/My%20Pack/js/host/templates.js"), "My Pack");
});

test("a host that lists templates in another way is left alone", () => {
  const api = { getWorkflowTemplates: () => ({}) };
  const before = api.getWorkflowTemplates;
  presentTemplates(api);
  assert.equal(api.getWorkflowTemplates, before);
});
