// Reads a COPC file by copc: copc.mjs FILE. Prints the octree's cube and spacing, then a node a line: level, x, y, z,
// place, bytes and points. Writes the records of the nodes' points, in this order, to FILE.records.
import { Copc } from "copc";
import { writeFile } from "node:fs/promises";

const [file] = process.argv.slice(2);
const copc = await Copc.create(file);
console.log([...copc.info.cube, copc.info.spacing].join(" "));

const nodes = [];
const pages = [copc.info.rootHierarchyPage];
for (const page of pages) {
  const subtree = await Copc.loadHierarchyPage(file, page);
  pages.push(...Object.values(subtree.pages));
  nodes.push(...Object.entries(subtree.nodes).map(([key, node]) => ({ key: key.split("-").map(Number), ...node })));
}
nodes.sort((a, b) => a.key.map((number, k) => number - b.key[k]).find((difference) => difference !== 0) ?? 0);

const records = [];
for (const node of nodes) {
  console.log([...node.key, node.pointDataOffset, node.pointDataLength, node.pointCount].join(" "));
  if (node.pointCount > 0) records.push(await Copc.loadPointDataBuffer(file, copc.header, node));
}
await writeFile(`${file}.records`, Buffer.concat(records));
