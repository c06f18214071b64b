// Opens a scene with glTF Transform and prints its meshes and what moves them, as JSON. Usage: node read_gltf.mjs FILE.glb
import { NodeIO } from "@gltf-transform/core";
import { readFileSync } from "node:fs";

const document = await new NodeIO().readBinary(new Uint8Array(readFileSync(process.argv[2])));
const numbers = (accessor) => [...accessor.getArray()];
const meshes = document.getRoot().listNodes().filter((node) => node.getMesh()).map((node) => {
  const [primitive] = node.getMesh().listPrimitives();
  return {
    name: node.getName(),
    matrix: node.getWorldMatrix(),
    rest: numbers(primitive.getAttribute("POSITION")),
    targets: primitive.listTargets().map((target) => numbers(target.getAttribute("POSITION"))),
    ...motionOf(node),
  };
});

function motionOf(node) {
  const channels = document.getRoot().listAnimations().flatMap((animation) => animation.listChannels());
  const channel = channels.find((each) => each.getTargetNode() === node);
  if (!channel) return { times: [], weights: [] };
  const sampler = channel.getSampler();
  return { times: numbers(sampler.getInput()), weights: numbers(sampler.getOutput()), how: sampler.getInterpolation() };
}
console.log(JSON.stringify(meshes));
