// Decompresses LAZ by laz-perf: laz.mjs FILE... Writes the records of FILE's points to FILE.records.
import { createLazPerf } from "laz-perf";
import { readFile, writeFile } from "node:fs/promises";

const library = await createLazPerf();
for (const file of process.argv.slice(2)) {
  const bytes = new Uint8Array(await readFile(file));
  const from = library._malloc(bytes.length);
  library.HEAPU8.set(bytes, from);
  const reader = new library.LASZip();
  reader.open(from, bytes.length);
  const size = reader.getPointLength();
  const to = library._malloc(size);
  const records = new Uint8Array(size * reader.getCount());
  for (let at = 0; at < records.length; at += size) {
    reader.getPoint(to);
    records.set(library.HEAPU8.subarray(to, to + size), at);
  }
  reader.delete();
  library._free(from);
  library._free(to);
  await writeFile(`${file}.records`, records);
}
