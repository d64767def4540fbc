// A binary glTF by Khronos' validator and the reader of glTF-Transform: node read_gltf.mjs LINES.jsonl FILE.glb
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

import { NodeIO } from "@gltf-transform/core";
import validator from "gltf-validator";

import { ROUNDED_M, framesOf, near } from "./lines.mjs";

const [, , lines, path] = process.argv;
const frames = framesOf(lines);
const bytes = new Uint8Array(readFileSync(path));
const { issues, info } = await validator.validateBytes(bytes);
assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages));
assert.equal(info.animationCount, 1);

const root = (await new NodeIO().readBinary(bytes)).getRoot();
const keys = new Map();  // of a node: its turns and places by frame
for (const channel of root.listAnimations()[0].listChannels()) {
  const sampler = channel.getSampler(), times = sampler.getInput();
  assert.equal(times.getCount(), frames.length);
  frames.forEach((frame, i) => near(times.getElement(i, []), [frame.t_s - frames[0].t_s], 1e-4, "a time"));
  keys.set(`${channel.getTargetPath()} of ${channel.getTargetNode().getName()}`, sampler.getOutput());
}

const product = ([x, y, z, w], [a, b, c, d]) =>
  [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a, w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c];
const turned = (q, v) => product(product(q, [...v, 0]), [-q[0], -q[1], -q[2], q[3]]).slice(0, 3);
// Places of a node and all below it, by name.
function place(node, i, from, turn, out) {
  const key = (what, otherwise) => keys.get(`${what} of ${node.getName()}`)?.getElement(i, []) ?? otherwise;
  const at = turned(turn, key("translation", node.getTranslation())).map((value, axis) => value + from[axis]);
  const now = product(turn, key("rotation", node.getRotation()));
  out.set(node.getName(), at);
  for (const child of node.listChildren()) place(child, i, at, now, out);
  return out;
}

const BONES = [["LeftArm", "LeftForeArm"], ["LeftForeArm", "LeftWrist"], ["RightArm", "RightForeArm"], ["RightForeArm", "RightWrist"]];
const JOINTS = { Arm: "shoulder", ForeArm: "elbow", Wrist: "wrist" };
const jointOf = (name) => name.replace(/^(Left|Right)(.*)$/, (_, side, bone) => `${side.toLowerCase()}_${JOINTS[bone]}`);
const yUp = ([x, y, z]) => [x, -y, -z];  // of the rig frame
const direction = (a, b) => {
  const d = b.map((value, axis) => value - a[axis]);
  return d.map((value) => value / Math.hypot(...d));
};
let compared = 0;
frames.forEach((frame, i) => {
  const joints = frame.people[0]?.joints;
  if (joints === undefined || ["pelvis", "spine", "chest"].some((name) => joints[name].state === "lost")) return;
  const places = place(root.listScenes()[0].listChildren()[0], i, [0, 0, 0], [0, 0, 0, 1], new Map());
  near(places.get("Hips"), yUp(joints.pelvis.p_in_rig_m), ROUNDED_M, "Hips");
  for (const [from, to] of BONES) {
    const ends = [joints[jointOf(from)], joints[jointOf(to)]];
    if (ends.some((joint) => joint.state === "lost")) continue;
    const want = direction(places.get(from), yUp(ends[1].p_in_rig_m));  // lengths are constant: a bone reaches out for its joint
    near(direction(places.get(from), places.get(to)), want, 0.002, `${from} of frame ${frame.frame}`);
    ++compared;
  }
});
assert.ok(compared > frames.length);
console.log(`glTF: valid; ${frames.length} frames, ${compared} bones point where the joints are`);
