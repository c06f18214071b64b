import assert from "node:assert/strict";
import test from "node:test";

import { scaleOf } from "../../nodes/web/js/panels/slider.js";
import { Playback } from "../../nodes/web/js/preview/playback.js";
import { CONTACT_FIELDS, fieldsOf, SCENE_FIELDS, WIND_FIELDS } from "../../nodes/web/js/scene/fields.js";
import { canonical } from "../../nodes/web/js/scene/canonical.js";

const ITEMS = [
  [{ list: "strokes", index: 0 }, {}],
  [{ list: "paint", index: 0 }, {}],
  ...["pinned", "path", "wave", "swing", "rotation", "squash", "pulse"].map((type) => [{ list: "rig_points", index: 0 }, { motion: { type } }]),
];
const FIELDS = [...ITEMS.flatMap(([reference, item]) => fieldsOf(reference, item)), ...SCENE_FIELDS, ...WIND_FIELDS, ...CONTACT_FIELDS];

test("a slider offers only what its field takes, and comes back to the value", () => {
  const sliders = FIELDS.map((field) => [field, scaleOf(field, field.default, 1280)]).filter(([, scale]) => scale);
  assert.ok(sliders.length >= 20, String(sliders.length));
  for (const [field, scale] of sliders) {
    for (const share of [0, 0.25, 0.5, 1]) {
      const value = scale.value(share);
      assert.ok(value >= field.min - 1e-9 && value <= field.max + 1e-9, `${field.path} ${value}`);
      assert.ok(Math.abs(scale.share(value) - share) < 1e-9, field.path);
    }
    assert.ok(scale.share(field.default) >= 0 && scale.share(field.default) <= 1, field.path);
  }
});

test("a slider reaches a value that is beyond what is usual", () => {
  const [radius] = FIELDS.filter((field) => field.path === "radius");
  assert.equal(scaleOf(radius, 5000, 1280).high, 5000);
  assert.equal(scaleOf(radius, NaN, 1280), null);
});

test("only a motion that is there is played", () => {
  const playback = new Playback();
  assert.deepEqual([playback.playing, playback.moving, playback.plays], [true, false, false]);
  playback.begin({ frames: 3, frame_rate: 24 }, 0);
  assert.equal(playback.plays, false);
  for (const number of [0, 1]) playback.add({ number });
  assert.equal(playback.plays, true);
  playback.toggle();
  assert.deepEqual([playback.moving, playback.plays], [true, false]);
  playback.clear();
  assert.equal(playback.moving, false);
});

test("the order of keys is no other scene", () => {
  assert.equal(canonical({ a: 1, b: [{ d: 2, c: 1 }] }), canonical(JSON.parse('{"b": [{"c": 1.0, "d": 2}], "a": 1e0}')));
  assert.notEqual(canonical({ a: [1, 2] }), canonical({ a: [2, 1] }));
  assert.notEqual(canonical({ a: 1 }), canonical({ a: 1.5 }));
});
