// What a hand holds in the place of a point: a mesh, or the convex hull of its samples, one for each finger.

import {
  BufferAttribute, BufferGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh,
  MeshLambertMaterial, Quaternion, SphereGeometry, Vector3, type Color, type Object3D,
} from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import type { ToolMessage } from "../protocol/decode";

const kBall = new SphereGeometry(1, 12, 8).getAttribute("position"); // what a sample with a radius adds to a hull
const kGhost = 0.3; // opacity of the hand's (judgement)

interface Part {
  side: number; // -1, 0, 1
  geometry: BufferGeometry;
  edges: BufferGeometry; // that are sharp
}

const kSharp = 20; // degrees, as of the samples along creases

function part(side: number, geometry: BufferGeometry): Part {
  return { side, geometry, edges: new EdgesGeometry(geometry, kSharp) };
}

function faceted(corners: Float32Array): BufferGeometry {
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(corners.slice(), 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Of a side's samples. A side that is flat or a point has no hull: nothing of it is drawn. */
function hull(samples: Float32Array, side: number): BufferGeometry | undefined {
  const points: Vector3[] = [];
  for (let i = 0; i < samples.length; i += 5) {
    const [x, y, z, radius, of] = samples.subarray(i, i + 5) as unknown as [number, number, number, number, number];
    if (of !== side) continue;
    if (radius === 0) points.push(new Vector3(x, y, z));
    else for (let k = 0; k < kBall.count; k += 1) points.push(new Vector3().fromBufferAttribute(kBall, k).multiplyScalar(radius).add(new Vector3(x, y, z)));
  }
  return points.length < 4 ? undefined : new ConvexGeometry(points);
}

function partsOf({ samples, faces }: ToolMessage): Part[] {
  if (faces.length > 0) return [part(0, faceted(faces))];
  return [-1, 0, 1].flatMap((side) => {
    const geometry = hull(samples, side);
    return geometry === undefined ? [] : [part(side, geometry)];
  });
}

export class ToolShape {
  readonly proxy = new Group();
  readonly hand = new Group();
  readonly orientation = new Quaternion(); // of the proxy
  readonly extent: number; // from the handle, m
  readonly opens: boolean;
  private readonly solid = new MeshLambertMaterial({ side: DoubleSide });
  private readonly line = new LineBasicMaterial();
  private readonly ghost = new MeshLambertMaterial({ transparent: true, opacity: kGhost, depthWrite: false, side: DoubleSide });
  private readonly axis: Vector3;
  private opening = 0; // of the proxy, m
  private readonly parts: Part[];

  /** The colours are shared: they follow the theme. The hand's is of its ghost, seen where the surface keeps the tool from it. */
  constructor(private readonly message: ToolMessage, proxy: Color, hand: Color) {
    this.axis = new Vector3(...message.axis);
    this.parts = partsOf(message);
    this.solid.color = proxy;
    this.ghost.color = this.line.color = hand;
    for (const { geometry, edges } of this.parts) {
      this.add(this.proxy, new Mesh(geometry, this.solid), new LineSegments(edges, this.line));
      this.add(this.hand, new Mesh(geometry, this.ghost));
    }
    const { samples } = message;
    let extent = 0;
    let opens = false;
    for (let i = 0; i < samples.length; i += 5) {
      extent = Math.max(extent, Math.hypot(samples[i]!, samples[i + 1]!, samples[i + 2]!) + samples[i + 3]!);
      opens ||= samples[i + 4] !== 0;
    }
    this.extent = extent;
    this.opens = opens;
  }

  dispose(): void {
    for (const each of [this.solid, this.line, this.ghost]) each.dispose();
    for (const { geometry, edges } of this.parts) for (const each of [geometry, edges]) each.dispose();
  }

  placeProxy(position: Vector3, orientation: Quaternion, opening: number): void {
    this.orientation.copy(orientation);
    this.opening = opening;
    this.place(this.proxy, position, orientation, opening);
  }

  placeHand(position: Vector3, orientation: Quaternion, opening: number): void {
    this.place(this.hand, position, orientation, opening);
  }

  /** How far the proxy reaches from its handle in a direction (unit), m. */
  reach(direction: Vector3): number {
    const local = direction.clone().applyQuaternion(this.orientation.clone().invert());
    const opened = 0.5 * this.opening * this.axis.dot(local);
    const { samples } = this.message;
    let most = -Infinity;
    for (let i = 0; i < samples.length; i += 5) {
      const along = local.x * samples[i]! + local.y * samples[i + 1]! + local.z * samples[i + 2]!;
      most = Math.max(most, along + samples[i + 3]! + samples[i + 4]! * opened);
    }
    return most;
  }

  private add(group: Group, ...objects: Object3D[]): void {
    for (const object of objects) object.renderOrder = 4;
    group.add(new Group().add(...objects));
  }

  private place(group: Group, position: Vector3, orientation: Quaternion, opening: number): void {
    group.position.copy(position);
    group.quaternion.copy(orientation);
    group.children.forEach((finger, i) => finger.position.copy(this.axis).multiplyScalar(0.5 * this.parts[i]!.side * opening));
  }
}
