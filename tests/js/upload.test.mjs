import assert from "node:assert/strict";
import test from "node:test";
import { uploadOf } from "../../nodes/web/js/host/upload.js";

const files = (...names) => names.map((name) => ({ name }));
const names = (upload) => upload && [upload.subfolder, ...upload.files.map((file) => file.name)];

test("a layered file is uploaded alone, whatever is dropped beside it", () => {
  assert.deepEqual(names(uploadOf(files("note.txt", "少女.PSD", "a.png"), "new")), ["", "少女.PSD"]);
  assert.deepEqual(names(uploadOf(files("girl.ora"), "new")), ["", "girl.ora"]);
});

test("several pictures become a folder", () => {
  assert.deepEqual(names(uploadOf(files("1 sky.png", "2 hair.PNG", "x_layers.json", "raw.tif"), "new")), [
    "new",
    "1 sky.png",
    "2 hair.PNG",
    "x_layers.json",
  ]);
});

test("a single picture and nothing at all are no layers", () => {
  assert.equal(uploadOf(files("girl.png"), "new"), null);
  assert.equal(uploadOf([], "new"), null);
});
