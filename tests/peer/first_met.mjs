// Finds the first triangle on each way by three-mesh-bvh: first_met.mjs FILE. FILE is JSON: vertices and triangles, flat, and
// ways of six numbers. Prints a triangle's number or -1 for each way. Front sides alone are met.
import { readFileSync } from "node:fs";
import { BufferAttribute, BufferGeometry, FrontSide, Ray, Vector3 } from "three";
import { MeshBVH } from "three-mesh-bvh";

const { vertices, triangles, ways } = JSON.parse(readFileSync(process.argv[2], "utf8"));
const geometry = new BufferGeometry();
geometry.setAttribute("position", new BufferAttribute(new Float32Array(vertices), 3));
geometry.setIndex(new BufferAttribute(new Uint32Array(triangles), 1));
const tree = new MeshBVH(geometry, { indirect: true }); // the triangles keep their numbers
for (const way of ways) {
  const from = new Vector3(...way.slice(0, 3));
  const to = new Vector3(...way.slice(3));
  const ray = new Ray(from, to.clone().sub(from).normalize());
  console.log(tree.raycastFirst(ray, FrontSide, 0, from.distanceTo(to))?.faceIndex ?? -1);
}
