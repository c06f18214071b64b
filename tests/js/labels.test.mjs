import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

// As in a page whose language is Japanese: the words come before everything else.
const words = new URL("../../nodes/web/words/ja.json", import.meta.url);
globalThis.document = /** @type {any} */ ({});
Object.defineProperty(globalThis, "navigator", { value: { language: "ja-JP" }, configurable: true });
globalThis.fetch = /** @type {any} */ (async (url) => {
  assert.equal(String(url), String(words));
  return { ok: true, json: async () => JSON.parse(readFileSync(words, "utf8")) };
});
const { say } = await import("../../nodes/web/js/host/words.js");
const { translateWidget, translateWidgets } = await import("../../nodes/web/js/host/labels.js");

test("without a host's setting the browser's language counts", () => {
  assert.equal(say("Undo"), "元に戻す");
  assert.equal(say("Body {number}", { number: 2 }), "ボディ 2");
  assert.equal(say("no such text"), "no such text");
});

test("options are shown in the user's language and stay what they are", () => {
  const widget = { value: "wind", options: { values: ["wind", "repel", "attract"] } };
  translateWidget(widget);
  assert.deepEqual(widget.options.values.map(widget.options.getOptionLabel), ["風", "反発", "吸引"]);
  assert.equal(widget.options.getOptionLabel(null), "");
  assert.equal(widget.value, "wind");
});

test("a list of files keeps the host's own menu", () => {
  const widget = { options: { values: ["model.ckpt", "other.ckpt"] } };
  translateWidget(widget);
  assert.equal("getOptionLabel" in widget.options, false);
});

test("widgets that a choice brings later are translated too", async () => {
  class Node {
    addWidget(type, name) {
      return { type, name, options: {} };
    }
  }
  translateWidgets(Node);
  const widget = new Node().addWidget("number", "radius");
  widget.tooltip = "What it covers follows.";
  await null;
  assert.equal(widget.tooltip, "マスクが覆う所が従います。");
});
