// Reads bags by others' readers, indexed and streaming, CRCs checked, and decodes every message by its
// schema: read.mjs FILE... Prints what it found as JSON; exits with 1, and says why, where a reader balks.
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";
import { readFile } from "node:fs/promises";

await Promise.all([lz4.isLoaded, zstd.isLoaded]);
const decompressHandlers = {
  lz4: (bytes, size) => new Uint8Array(lz4(bytes, Number(size))),
  zstd: (bytes, size) => new Uint8Array(zstd.decompress(bytes, Number(size))),
};
const text = new TextDecoder();

// Counts messages by topic, and keeps the last of each.
class Decoder {
  readers = new Map();
  counts = {};
  last = {};

  take(message, channels, schemas) {
    const channel = channels.get(message.channelId);
    const schema = schemas.get(channel.schemaId);
    let reader = this.readers.get(channel.id);
    if (reader == undefined) {
      reader = new MessageReader(parse(text.decode(schema.data), { ros2: true }));
      this.readers.set(channel.id, reader);
    }
    this.last[channel.topic] = reader.readMessage(message.data);
    this.counts[channel.topic] = (this.counts[channel.topic] ?? 0) + 1;
  }
}

async function indexed(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoder = new Decoder();
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    decoder.take(message, reader.channelsById, reader.schemasById);
  }
  const attachments = [];
  for await (const each of reader.readAttachments()) attachments.push([each.name, each.data.length]);
  const metadata = [];
  for await (const each of reader.readMetadata()) metadata.push(each.name);
  return { counts: decoder.counts, last: decoder.last, attachments, metadata,
    statistics: Number(reader.statistics.messageCount), profile: reader.header.profile };
}

function streamed(bytes) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const decoder = new Decoder();
  const channels = new Map();
  const schemas = new Map();
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "Message") decoder.take(record, channels, schemas);
  }
  return { counts: decoder.counts, done: reader.done() };
}

const found = [];
for (const file of process.argv.slice(2)) {
  const bytes = new Uint8Array(await readFile(file));
  try {
    found.push({ indexed: await indexed(bytes), streamed: streamed(bytes) });
  } catch (error) {
    console.error(`${file}: ${error.stack}`);
    process.exit(1);
  }
}
const plain = (key, value) =>
  typeof value === "bigint" ? Number(value) : ArrayBuffer.isView(value) ? Array.from(value) : value;
console.log(JSON.stringify(found, plain));
