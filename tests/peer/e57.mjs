// Reads E57 files by web-e57: e57.mjs FILE... Prints a point a line, x y z and its colour if it has one; exits with 1,
// and says why, where the reader balks. The package is made for bundlers, so its WebAssembly is put together here.
import * as reader from "./node_modules/web-e57/e57_bg.js";
import { readFile } from "node:fs/promises";

const code = await readFile(new URL("node_modules/web-e57/e57_bg.wasm", import.meta.url));
const { instance } = await WebAssembly.instantiate(code, { "./e57_bg.js": reader });
reader.__wbg_set_wasm(instance.exports);
for (const file of process.argv.slice(2)) {
  try {
    process.stdout.write(reader.convertE57(new Uint8Array(await readFile(file)), "XYZ"));
  } catch (error) {
    console.error(`${file}: ${error}`);
    process.exit(1);
  }
}
