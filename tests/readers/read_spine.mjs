// Opens a skeleton with Spine's own runtime and prints what it would draw at some times, as JSON.
// Usage: node read_spine.mjs SKELETON.json SKELETON.atlas TIME,TIME,...
import { readFileSync } from "node:fs";
import * as spine from "@esotericsoftware/spine-core";

const [json, text, times] = process.argv.slice(2);
const atlas = new spine.TextureAtlas(readFileSync(text, "utf8"));
for (const page of atlas.pages) page.setTexture(new spine.FakeTexture({ width: page.width, height: page.height }));
const data = new spine.SkeletonJson(new spine.AtlasAttachmentLoader(atlas)).readSkeletonData(readFileSync(json, "utf8"));
const skeleton = new spine.Skeleton(data);
const animation = data.findAnimation("motion");

function drawn(slot) {
  const attachment = slot.getAttachment();
  const common = { slot: slot.data.name, blend: slot.data.blendMode, page: attachment.region.page.name };
  if (attachment instanceof spine.MeshAttachment) {
    const vertices = new Array(attachment.worldVerticesLength);
    attachment.computeWorldVertices(slot, 0, vertices.length, vertices, 0, 2);
    return { ...common, vertices, uvs: [...attachment.uvs], triangles: attachment.triangles, hull: attachment.hullLength / 2 };
  }
  const vertices = new Array(8);
  attachment.computeWorldVertices(slot, vertices, 0, 2);
  return { ...common, vertices, uvs: [...attachment.uvs], triangles: [0, 1, 2, 2, 3, 0], hull: 4 };
}

const frames = times.split(",").map((time) => {
  skeleton.setToSetupPose();
  animation.apply(skeleton, 0, Number(time), false, null, 1, spine.MixBlend.replace, spine.MixDirection.mixIn);
  skeleton.updateWorldTransform(spine.Physics.none);
  return skeleton.drawOrder.map(drawn);
});
const head = { version: data.version, fps: data.fps, duration: animation.duration, width: data.width, height: data.height };
console.log(JSON.stringify({ ...head, x: data.x, y: data.y, frames }));
