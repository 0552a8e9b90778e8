// Reads Potree stores by potree-core: potree.mjs FOLDER... Writes the points of each node to FOLDER/peer.txt: its
// name and number of points, then a line a point: place, colour and intensity, as the viewer has them.
import { open, readFile, writeFile } from "node:fs/promises";
import vm from "node:vm";

// What potree-core takes from a browser: workers made of text, and nothing else that matters here.
const texts = [];
globalThis.self = globalThis;
globalThis.Blob = class {
  constructor(parts) {
    this.text = parts.join("");
  }
};
URL.createObjectURL = (blob) => `blob:${texts.push(blob.text) - 1}`;
URL.revokeObjectURL = () => {};
globalThis.Worker = class {
  constructor(url) {
    this.scope = { console, performance, postMessage: (data) => this.onmessage({ data }) };
    vm.createContext(this.scope);
    vm.runInContext(texts[Number(url.slice("blob:".length))], this.scope);
  }
  postMessage(data) {
    setImmediate(() => this.scope.onmessage({ data }));
  }
};
const { Potree } = await import("potree-core");

// Files in place of a server, which is asked for ranges of bytes.
const manager = {
  getUrl: async (url) => url,
  fetch: async (url, options) => {
    if (options?.headers?.Range == undefined) return new Response(await readFile(url));
    const [first, last] = options.headers.Range.slice("bytes=".length).split("-").map(Number);
    const file = await open(url);
    const bytes = Buffer.alloc(last - first + 1);
    await file.read(bytes, 0, bytes.length, first);
    await file.close();
    return new Response(bytes);
  },
};

async function loaded(node) {
  node.load();
  while (!node.loaded) {
    if (!node.loading) throw new Error(`${node.name} is not read`);
    await new Promise(setImmediate);
  }
}

async function textOf(node, corner) {
  await loaded(node);
  const { position, rgba, intensity } = node.geometry.attributes;
  const { min } = node.boundingBox;
  const lines = [`${node.name} ${node.numPoints}`];
  for (let i = 0; i < node.numPoints; i++) {
    const place = [0, 1, 2].map((k) => position.array[3 * i + k] + [min.x, min.y, min.z][k] + corner[k]);
    lines.push([...place, ...rgba.array.slice(4 * i, 4 * i + 3), intensity.array[i]].join(" "));
  }
  for (const child of node.children) if (child) lines.push(...(await textOf(child, corner)));
  return lines;
}

for (const folder of process.argv.slice(2)) {
  try {
    const { pcoGeometry } = await new Potree().loadPointCloud(`${folder}/metadata.json`, manager);
    const lines = await textOf(pcoGeometry.root, pcoGeometry.offset.toArray());
    await writeFile(`${folder}/peer.txt`, lines.join("\n"));
  } catch (error) {
    console.error(`${folder}: ${error.stack}`);
    process.exit(1);
  }
}
