// An MCAP file by Foxglove's readers: node read_mcap.mjs LINES.jsonl FILE.mcap
import assert from "node:assert/strict";
import { open } from "node:fs/promises";

import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";

import { ROUNDED_M, framesOf, near } from "./lines.mjs";

const [, , lines, path] = process.argv;
const frames = framesOf(lines);
const file = await open(path);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, size) => {
    const bytes = new Uint8Array(Number(size));
    assert.equal((await file.read(bytes, 0, bytes.length, Number(offset))).bytesRead, bytes.length);
    return bytes;
  },
};
const reader = await McapIndexedReader.Initialize({ readable });
assert.equal(reader.header.profile, "ros2");

// Messages by topic, read by the definitions that the file brings.
const messages = new Map();
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  assert.equal(channel.messageEncoding, "cdr");
  const schema = reader.schemasById.get(channel.schemaId);
  assert.equal(schema.encoding, "ros2msg");
  const definition = rosmsg.parse(new TextDecoder().decode(schema.data), { ros2: true });
  decoders.set(channel.id, { topic: channel.topic, reader: new serialization.MessageReader(definition) });
  messages.set(channel.topic, []);
}
for await (const message of reader.readMessages()) {
  const { topic, reader: decoder } = decoders.get(message.channelId);
  messages.get(topic).push({ ns: message.logTime, ...decoder.readMessage(message.data) });
}
await file.close();
const topics = ["/duoptic/depth/camera_info", "/duoptic/depth/image", "/duoptic/people", "/duoptic/points", "/tf"];
assert.deepEqual([...messages.keys()].sort(), topics);
for (const topic of topics) assert.equal(messages.get(topic).length, frames.length, topic);
const at = (topic, i) => messages.get(topic)[i];
const nsOf = (stamp) => BigInt(stamp.sec) * 1_000_000_000n + BigInt(stamp.nsec ?? stamp.nanosec);
const bytesOf = (array) => new DataView(array.buffer, array.byteOffset, array.byteLength);

let places = 0, points = 0;
frames.forEach((frame, i) => {
  const image = at("/duoptic/depth/image", i), camera = at("/duoptic/depth/camera_info", i), cloud = at("/duoptic/points", i);
  assert.ok(Math.abs(Number(image.ns) / 1e9 - frame.t_s) < 1e-6);
  for (const message of [image, camera, cloud]) {
    assert.equal(nsOf(message.header.stamp), image.ns);
    assert.equal(message.header.frame_id, "duoptic_left");
  }
  assert.equal(image.encoding, "32FC1");
  assert.deepEqual([camera.width, camera.height, 4 * image.width], [image.width, image.height, image.step]);

  // Each point of the cloud is the pixel that the camera sees it at, with that pixel's depth.
  const depths = bytesOf(image.data), xyz = bytesOf(cloud.data);
  assert.deepEqual(cloud.fields.map((field) => [field.name, field.offset]), [["x", 0], ["y", 4], ["z", 8], ["rgb", 12]]);
  const known = Array.from({ length: image.width * image.height }, (_, p) => depths.getFloat32(4 * p, true)).filter((z) => z > 0).length;
  assert.equal(known, cloud.width * cloud.height);
  for (let p = 0; p < cloud.width; p += 17) {
    const [x, y, z] = [0, 4, 8].map((offset) => xyz.getFloat32(cloud.point_step * p + offset, true));
    const u = camera.k[0] * x / z + camera.k[2], v = camera.k[4] * y / z + camera.k[5];
    near([u, v], [Math.round(u), Math.round(v)], 1e-3, "a pixel");
    assert.equal(depths.getFloat32(image.step * Math.round(v) + 4 * Math.round(u), true), z);
    ++points;
  }

  const transforms = new Map(at("/tf", i).transforms.map((one) => [one.child_frame_id, one.transform]));
  let joints = 0;
  for (const person of frame.people)
    for (const [name, joint] of Object.entries(person.joints)) {
      const transform = transforms.get(`person_${person.id}/${name}`);
      assert.equal(transform !== undefined, joint.state !== "lost");
      if (transform === undefined) continue;
      const { x, y, z } = transform.translation, { x: qx, y: qy, z: qz, w: qw } = transform.rotation;
      near([x, y, z], joint.p_in_rig_m, ROUNDED_M, name);
      near([Math.hypot(qx, qy, qz, qw)], [1], 1e-9, "a turn");
      ++joints;
    }
  assert.equal(transforms.size, joints);
  const spheres = at("/duoptic/people", i).markers.filter((marker) => marker.ns === "joints");
  assert.equal(spheres.reduce((sum, marker) => sum + marker.points.length, 0), joints);
  places += joints;
});
assert.ok(places > 0 && points > 0);
console.log(`MCAP: ${frames.length} frames, ${places} places of joints and ${points} points are what they should be`);
