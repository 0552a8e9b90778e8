// Builds dist/, or the folder that PALPATE_PAGE names: index.html, app.js, app.css. --watch builds again at every change; --tests compiles the
// tests of the pure parts to .test-build/.

import { build, context } from "esbuild";
import { cp, mkdir, readdir, rm, stat } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const kBound = 900_000; // bytes of the three files together
const root = dirname(fileURLToPath(import.meta.url));
const at = (...parts) => join(root, ...parts);
const out = process.env.PALPATE_PAGE ?? at("dist");

const page = {
  absWorkingDir: root,
  entryPoints: { app: "src/main.ts" },
  outdir: out,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["es2022"],
  legalComments: "inline",
  logLevel: "warning",
};

async function buildPage(watch) {
  await mkdir(out, { recursive: true });
  await cp(at("src/index.html"), join(out, "index.html"));
  if (watch) return (await context(page)).watch();
  await build(page);
  let sum = 0;
  for (const name of ["index.html", "app.js", "app.css"]) {
    const { size } = await stat(join(out, name));
    console.log(`${name.padEnd(10)} ${(size / 1000).toFixed(1).padStart(7)} kB`);
    sum += size;
  }
  console.log(`${"all".padEnd(10)} ${(sum / 1000).toFixed(1).padStart(7)} kB`);
  if (sum > kBound) throw new Error(`the page has ${sum} bytes, more than ${kBound}`);
}

async function buildTests() {
  await rm(at(".test-build"), { recursive: true, force: true });
  const tests = (await readdir(at("test"))).filter((name) => name.endsWith(".test.ts"));
  await build({
    absWorkingDir: root,
    entryPoints: tests.map((name) => `test/${name}`),
    outdir: ".test-build",
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    target: ["node18"],
    logLevel: "warning",
  });
}

if (process.argv.includes("--tests")) await buildTests();
else await buildPage(process.argv.includes("--watch"));
