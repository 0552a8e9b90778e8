// Writes a bag by others' writer: write.mjs FILE none|lz4|zstd|loose. 1000 messages on each of two topics,
// geometry_msgs/Point at 100 Hz from time 0, x counts them; an attachment and metadata.
import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { compressors, fileOf } from "./common.mjs";

const [path, kind] = process.argv.slice(2);
const { writable, close } = await fileOf(path);
const compress = await compressors();
const writer = new McapWriter({ writable, chunkSize: 20_000, useChunks: kind !== "loose", compressChunk: compress[kind] });
await writer.start({ profile: "ros2", library: "@mcap/core" });
const definition = "float64 x\nfloat64 y\nfloat64 z\n";
const encoder = new MessageWriter(parse(definition, { ros2: true }));
const schemaId = await writer.registerSchema({
  name: "geometry_msgs/msg/Point", encoding: "ros2msg", data: new TextEncoder().encode(definition) });
const channels = [];
for (const topic of ["/a", "/b"]) {
  channels.push(await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() }));
}
for (let i = 0; i < 1000; ++i) {
  for (const channelId of channels) {
    const data = encoder.writeMessage({ x: i, y: channelId, z: 0.5 });
    await writer.addMessage({ channelId, sequence: i, logTime: BigInt(i) * 10_000_000n, publishTime: 0n, data });
  }
}
await writer.addAttachment({ name: "notes.txt", mediaType: "text/plain", logTime: 1n, createTime: 2n, data: new Uint8Array([1, 2, 3]) });
await writer.addMetadata({ name: "made", metadata: new Map([["by", "others"]]) });
await writer.end();
await close();
