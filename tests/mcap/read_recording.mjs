// Reads a recording with the public readers of MCAP, and checks its messages against Foxglove's
// own schemas. Arguments: the recording and the plan.json that it is of.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import foxglove from "@foxglove/schemas/jsonschema.js";
import { decompress } from "fzstd";

const [recording, planFile] = process.argv.slice(2);
const bytes = new Uint8Array(await readFile(recording));
const plan = JSON.parse(await readFile(planFile, "utf8"));
const decompressHandlers = {
  zstd: (packed, size) => decompress(packed, new Uint8Array(Number(size))),
};

/** Throws unless `value` is what the JSON schema wants (as much of it as these schemas use). */
function check(value, schema, path) {
  if (schema.oneOf) {
    assert(schema.oneOf.some((one) => one.const === value), `${path}: ${value}`);
  } else if (schema.type === "object") {
    assert.equal(typeof value, "object", path);
    for (const key of schema.required ?? []) assert(key in value, `${path}: no ${key}`);
    for (const key of Object.keys(value)) {
      assert(schema.properties?.[key], `${path}: unknown ${key}`);
      check(value[key], schema.properties[key], `${path}.${key}`);
    }
  } else if (schema.type === "array") {
    assert(Array.isArray(value), path);
    value.forEach((item, i) => check(item, schema.items, `${path}[${i}]`));
  } else if (schema.type === "integer") {
    assert(Number.isInteger(value), `${path}: ${value}`);
  } else if (schema.type) {
    assert.equal(typeof value, schema.type, path);
  }
}

// Front to back, with every CRC.
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(bytes);
const records = {};
for (let record; (record = stream.nextRecord()); ) {
  records[record.type] = (records[record.type] ?? 0) + 1;
}
assert(stream.done());
assert.equal(records.Footer, 1);

// By its indexes, in the order of time.
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.slice(Number(offset), Number(offset + size)),
};
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const counts = {};
const texts = {};
let time = 0n;
for await (const message of reader.readMessages()) {
  assert(message.logTime >= time);
  time = message.logTime;
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  const text = JSON.parse(new TextDecoder().decode(message.data));
  const known = foxglove[schema.name.replace("foxglove.", "")];
  if (schema.name.startsWith("foxglove.")) check(text, known, channel.topic);
  check(text, JSON.parse(new TextDecoder().decode(schema.data)), channel.topic);
  counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
  texts[channel.topic] = text;
}
assert.equal(records.Message, Object.values(counts).reduce((sum, n) => sum + n));
assert.equal(BigInt(records.Message), reader.statistics.messageCount);

// The last message is the plan's end.
const knot = plan.segments.at(-1).phases.at(-1);
assert.equal(Number(time), Math.round(knot.t.at(-1) * 1e9));
const joints = texts["/joint_states"].joints;
assert.deepEqual(joints.map((joint) => joint.name), plan.joints);
joints.forEach((joint, i) => assert(Math.abs(joint.position - knot.q.at(-1)[7 + i]) < 1e-6));
const root = texts["/tf"].transforms[0];
assert.equal(root.parent_frame_id, "world");
assert(Math.abs(root.translation.z - knot.q.at(-1)[6]) < 1e-6);
assert.match(texts["/robot_description"].data, /<robot/);
assert(texts["/scene"].entities.length > 0);

const seconds = Number(time) / 1e9;
assert((bytes.length * 60) / seconds <= 5e6, `${bytes.length} bytes in ${seconds} s`);
console.log(`${bytes.length} bytes, ${seconds} s, ${records.Message} messages`);
