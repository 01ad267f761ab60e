// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file by its index with packages that are not ours, and checks what the test wrote into it.
// Usage: node read_mcap.mjs NODE_MODULES FILE
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import assert from "node:assert";

const need = createRequire(process.argv[2] + "/x.js");
const { McapIndexedReader } = need("@mcap/core");
const { parse } = need("@foxglove/rosmsg");
const { MessageReader } = need("@foxglove/rosmsg2-serialization");
const fzstd = need("fzstd");
const lz4 = need("lz4js");

const bytes = new Uint8Array(readFileSync(process.argv[3]));
const reader = await McapIndexedReader.Initialize({
  readable: {
    size: async () => BigInt(bytes.length),
    read: async (at, size) => bytes.subarray(Number(at), Number(at) + Number(size)),
  },
  decompressHandlers: {
    zstd: (data, size) => fzstd.decompress(data, new Uint8Array(Number(size))),
    lz4: (data, size) => lz4.decompress(data, Number(size)),
  },
});
const readers = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  assert.equal(schema.encoding, "ros2msg");
  assert.match(channel.metadata.get("offered_qos_profiles"), /durability: [12]/);
  const definition = new TextDecoder().decode(schema.data);
  readers.set(channel.id, new MessageReader(parse(definition, { ros2: true })));
}
const counts = {};
let before = 0n;
for await (const message of reader.readMessages()) {
  const topic = reader.channelsById.get(message.channelId).topic;
  counts[topic] = (counts[topic] ?? 0) + 1;
  assert(message.logTime >= before);
  before = message.logTime;
  const value = readers.get(message.channelId).readMessage(message.data);
  if (topic === "/velodyne_points") {
    assert.equal(value.header.frame_id, "velodyne");
    assert.deepEqual(value.fields.map((field) => field.name), ["x", "y", "z", "intensity", "ring", "time"]);
    assert.equal(value.data.length, value.height * value.row_step);
  }
  if (topic === "/odom") assert.equal(value.child_frame_id, "base_link");
  if (topic === "/imu/data") assert.equal(value.linear_acceleration.z, 9.81);
  if (topic === "/tf_static") assert.equal(value.transforms[0].transform.translation.x, 0.1);
}
assert.equal(counts["/velodyne_points"], 4);
assert.equal(counts["/ground_truth/odom"], 4);
assert.equal(counts["/tf_static"], 1);
assert.equal(counts["/odom"], counts["/tf"]);
assert.equal(Number(reader.statistics.messageCount), Object.values(counts).reduce((a, b) => a + b));
