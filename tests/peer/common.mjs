// What the programs of this folder have in common.
import lz4 from "lz4js";
import zstd from "@foxglove/wasm-zstd";
import { open } from "node:fs/promises";

// By the names that MCAP has for them.
export async function compressors() {
  await zstd.isLoaded;
  return {
    lz4: (bytes) => ({ compression: "lz4", compressedData: new Uint8Array(lz4.compress(bytes)) }),
    zstd: (bytes) => ({ compression: "zstd", compressedData: new Uint8Array(zstd.compress(bytes)) }),
  };
}

// A file for McapWriter.
export async function fileOf(path) {
  const file = await open(path, "w");
  let size = 0;
  const writable = {
    position: () => BigInt(size),
    write: async (bytes) => {
      await file.write(bytes);
      size += bytes.length;
    },
  };
  return { writable, close: () => file.close() };
}

// A type and all that it is made of, the root first and without a name, as a parser gives it.
export function withParts(all, name) {
  const parts = new Map();
  const add = (each) => {
    if (parts.has(each)) return;
    parts.set(each, all[each]);
    for (const field of all[each].definitions) if (field.isComplex) add(field.type);
  };
  add(name);
  return [...parts.values()].map((each) => (each.name === name ? { ...each, name: undefined } : each));
}
