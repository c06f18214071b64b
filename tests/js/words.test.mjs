import assert from "node:assert/strict";
import { test } from "node:test";

import { say, words } from "../../nodes/web/js/host/words.js";

test("a text without a translation is said in English with its values", () => {
  assert.equal(say("Body {number}", { number: 3 }), "Body 3");
});

test("what no value is given for stays as it stands, and a value is never read as a pattern", () => {
  assert.equal(say("{constructor} {name}", { name: "$& {name}" }), "{constructor} $& {name}");
});

test("texts marked for later are handed on as they are", () => {
  assert.deepEqual(words("wind", "repel"), ["wind", "repel"]);
});
