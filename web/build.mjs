// Builds dist/, or the folder that PALPATE_PAGE names: index.html, app.js, app.css. --watch builds again at every change; --tests compiles the
// tests of the pure parts to .test-build/; --tab FOLDER builds the page of a tab there, with worker.js, which wants tab.js and
// tab.wasm (scripts/tab.sh) beside it. --tab-package FOLDER VERSION builds there what another page includes it with.

import { build, context } from "esbuild";
import { execFileSync } from "node:child_process";
import { cp, mkdir, readdir, readFile, rm, stat, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
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

const kHead = /(?=<link rel="icon")/;

/** The same page, that finds its program in a worker. */
async function buildTab(folder) {
  await mkdir(folder, { recursive: true });
  const html = await readFile(at("src/index.html"), "utf8");
  if (!kHead.test(html)) throw new Error("index.html has no place for the tab's mark");
  await writeFile(join(folder, "index.html"), html.replace(kHead, '<meta name="palpate" content="tab">\n'));
  await build({ ...page, outdir: folder, entryPoints: { app: "src/main.ts", worker: "src/tab/worker.ts" } });
}

/** What scripts/tab.sh puts the page of a tab into. */
async function buildTabPackage(folder, version) {
  const from = at("tab_package");
  await build({ ...page, outdir: folder, entryPoints: [join(from, "index.ts")], format: "esm", minify: false });
  execFileSync(process.execPath, [at("node_modules/typescript/bin/tsc"), "--project", from, "--outDir", folder], { stdio: "inherit" });
  const about = JSON.parse(await readFile(join(from, "package.json"), "utf8"));
  await writeFile(join(folder, "package.json"), `${JSON.stringify({ ...about, version }, undefined, 2)}\n`);
  await cp(join(from, "README.md"), join(folder, "README.md"));
  await cp(at("../LICENSE"), join(folder, "LICENSE"));
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

const [what, folder, version] = process.argv.slice(2);
if (what === "--tests") await buildTests();
else if (what === "--tab") await buildTab(resolve(folder));
else if (what === "--tab-package") await buildTabPackage(resolve(folder), version);
else await buildPage(what === "--watch");
