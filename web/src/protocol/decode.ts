// Binary messages of the program. Positions are in metres relative to the scene's origin.
// Typed arrays look into the message itself: nothing is copied. They read in the host's byte order,
// which is little-endian wherever a browser runs.

import type { Quaternion, Vector } from "./messages";

export const Kind = { state: 1, cloud: 2, surface: 3, past: 4, tool: 5 } as const;

export const Flag = {
  touching: 1,
  paused: 2,
  taken: 4,
  clamped: 8,
  slewed: 16,
  watchdog: 32,
  fault: 64,
  thinned: 128,
  softer: 256,
  braked: 512,
  starting: 1024,
  softened: 2048,
  clutched: 4096,
  oriented: 8192,
  behind: 16384, // what a camera sees: nothing is felt from there
  notLoaded: 32768, // the cloud is not read or prepared there
  holdsTool: 65536, // that turns
  inside: 131072, // a tool that turns is, of a surface: nothing is felt until it is out
} as const;

/** A tool that turns; its proxy is the state's, turned and opened so. */
export interface ToolPart {
  orientation: Quaternion;
  opening: number; // m
  handOpening: number; // m, that the hand asks for
  torque: Vector; // N m, about the handle
  grip: number; // N
}

export interface StateMessage {
  kind: typeof Kind.state;
  device: number;
  flags: number;
  time: number; // s
  hip: Vector;
  proxy: Vector;
  normal: Vector; // of the tangent constraint
  force: Vector; // N, on the hand
  radius: number; // support radius R, m
  rate: number; // steps a second
  step: [number, number]; // s, p50 and p99
  lateness: [number, number]; // s, p50 and p99
  interval: number; // s, between samples
  samples: Float32Array; // N, x y z of each step, oldest first
  orientation: Quaternion | undefined; // of the hand, from the tool's axes; a point's tip is along y
  tool: ToolPart | undefined;
}

export interface CloudMessage {
  kind: typeof Kind.cloud;
  source: number;
  count: number;
  stamp: number; // s
  lower: Vector;
  extent: Vector;
  positions: Uint16Array; // lower + extent * u / 65535
  colours: Uint8Array | undefined;
  normals: Int8Array | undefined; // octahedral
  trust: Uint8Array | undefined; // 255 is 1
  radii: Uint8Array | undefined; // as radiusOf() reads them
  faded: boolean; // not confirmed for so long that it cannot be felt any more
}

export interface SurfaceMessage {
  kind: typeof Kind.surface;
  device: number;
  centre: Vector;
  extent: number; // centre + extent * v / 32767
  vertices: Int16Array;
  triangles: Uint16Array;
}

/** The forces before the moment of a recording that was sought last. */
export interface PastMessage {
  kind: typeof Kind.past;
  device: number;
  time: number; // s, of the last one
  samples: Float32Array; // s before that, N x y z of each step, oldest first
}

/** What a device holds in the place of a point, in its own axes, m from the handle. */
export interface ToolMessage {
  kind: typeof Kind.tool;
  device: number;
  axis: Vector; // in which the finger of side +1 opens
  samples: Float32Array; // x y z radius side of each; sides are -1, 0, 1
  faces: Float32Array; // corners of a mesh's triangles; none: the convex hull of each side's samples
}

export type BinaryMessage = StateMessage | CloudMessage | SurfaceMessage | PastMessage | ToolMessage;

export class DecodeError extends Error {}

function need(buffer: ArrayBuffer, bytes: number, what: string): void {
  if (buffer.byteLength < bytes) {
    throw new DecodeError(`${what}: ${buffer.byteLength} bytes instead of ${bytes}`);
  }
}

function vector(view: DataView, offset: number): Vector {
  return [
    view.getFloat32(offset, true),
    view.getFloat32(offset + 4, true),
    view.getFloat32(offset + 8, true),
  ];
}

function pair(view: DataView, offset: number): [number, number] {
  return [view.getFloat32(offset, true), view.getFloat32(offset + 4, true)];
}

function quaternion(view: DataView, offset: number): Quaternion {
  return [...vector(view, offset), view.getFloat32(offset + 12, true)];
}

function decodeTool(view: DataView, offset: number): ToolPart {
  return {
    orientation: quaternion(view, offset),
    opening: view.getFloat32(offset + 16, true),
    handOpening: view.getFloat32(offset + 20, true),
    torque: vector(view, offset + 24),
    grip: view.getFloat32(offset + 36, true),
  };
}

function decodeState(buffer: ArrayBuffer, view: DataView): StateMessage {
  need(buffer, 92, "state");
  const samples = view.getUint16(2, true);
  const flags = view.getUint32(4, true);
  const end = 92 + 12 * samples;
  const oriented = (flags & Flag.oriented) !== 0;
  const holds = (flags & Flag.holdsTool) !== 0;
  const after = end + (oriented ? 16 : 0);
  need(buffer, after + (holds ? 40 : 0), `state with ${samples} samples`);
  return {
    kind: Kind.state,
    device: view.getUint8(1),
    flags,
    time: view.getFloat64(8, true),
    hip: vector(view, 16),
    proxy: vector(view, 28),
    normal: vector(view, 40),
    force: vector(view, 52),
    radius: view.getFloat32(64, true),
    rate: view.getFloat32(68, true),
    step: pair(view, 72),
    lateness: pair(view, 80),
    interval: view.getFloat32(88, true),
    samples: new Float32Array(buffer, 92, 3 * samples),
    orientation: oriented ? quaternion(view, end) : undefined,
    tool: holds ? decodeTool(view, after) : undefined,
  };
}

/** m, of a byte of a cloud's radii; the cloud's shader does the same. */
export function radiusOf(byte: number): number {
  return 2 ** ((byte - 160) / 8);
}

function decodeCloud(buffer: ArrayBuffer, view: DataView): CloudMessage {
  need(buffer, 40, "cloud");
  const flags = view.getUint16(2, true);
  const count = view.getUint32(4, true);
  const colours = (flags & 1) !== 0;
  const normals = (flags & 2) !== 0;
  const afterPositions = 40 + 6 * count;
  const afterColours = afterPositions + (colours ? 3 * count : 0);
  const afterNormals = afterColours + (normals ? 2 * count : 0);
  const trust = (flags & 4) !== 0;
  const afterTrust = afterNormals + (trust ? count : 0);
  const radii = (flags & 8) !== 0;
  need(buffer, afterTrust + (radii ? count : 0), `cloud of ${count} points`);
  return {
    kind: Kind.cloud,
    source: view.getUint8(1),
    count,
    stamp: view.getFloat64(8, true),
    lower: vector(view, 16),
    extent: vector(view, 28),
    positions: new Uint16Array(buffer, 40, 3 * count),
    colours: colours ? new Uint8Array(buffer, afterPositions, 3 * count) : undefined,
    normals: normals ? new Int8Array(buffer, afterColours, 2 * count) : undefined,
    trust: trust ? new Uint8Array(buffer, afterNormals, count) : undefined,
    radii: radii ? new Uint8Array(buffer, afterTrust, count) : undefined,
    faded: (flags & 16) !== 0,
  };
}

function decodeSurface(buffer: ArrayBuffer, view: DataView): SurfaceMessage {
  need(buffer, 24, "surface");
  const vertices = view.getUint16(2, true);
  const triangles = view.getUint32(4, true);
  const afterVertices = 24 + 6 * vertices;
  need(buffer, afterVertices + 6 * triangles, `surface of ${triangles} triangles`);
  const message: SurfaceMessage = {
    kind: Kind.surface,
    device: view.getUint8(1),
    centre: vector(view, 8),
    extent: view.getFloat32(20, true),
    vertices: new Int16Array(buffer, 24, 3 * vertices),
    triangles: new Uint16Array(buffer, afterVertices, 3 * triangles),
  };
  if (message.triangles.some((vertex) => vertex >= vertices)) {
    throw new DecodeError(`surface: triangle index beyond its ${vertices} vertices`);
  }
  return message;
}

function decodePast(buffer: ArrayBuffer, view: DataView): PastMessage {
  need(buffer, 16, "past");
  const samples = view.getUint32(4, true);
  need(buffer, 16 + 16 * samples, `past with ${samples} samples`);
  return {
    kind: Kind.past,
    device: view.getUint8(1),
    time: view.getFloat64(8, true),
    samples: new Float32Array(buffer, 16, 4 * samples),
  };
}

function decodeShape(buffer: ArrayBuffer, view: DataView): ToolMessage {
  need(buffer, 24, "tool");
  const samples = view.getUint32(4, true);
  const faces = view.getUint32(8, true);
  need(buffer, 24 + 20 * samples + 36 * faces, `tool of ${samples} samples and ${faces} faces`);
  return {
    kind: Kind.tool,
    device: view.getUint8(1),
    axis: vector(view, 12),
    samples: new Float32Array(buffer, 24, 5 * samples),
    faces: new Float32Array(buffer, 24 + 20 * samples, 9 * faces),
  };
}

/** Throws DecodeError for what is cut short or of an unknown kind. */
export function decode(buffer: ArrayBuffer): BinaryMessage {
  need(buffer, 1, "message");
  const view = new DataView(buffer);
  const kind = view.getUint8(0);
  if (kind === Kind.state) return decodeState(buffer, view);
  if (kind === Kind.cloud) return decodeCloud(buffer, view);
  if (kind === Kind.surface) return decodeSurface(buffer, view);
  if (kind === Kind.past) return decodePast(buffer, view);
  if (kind === Kind.tool) return decodeShape(buffer, view);
  throw new DecodeError(`unknown message kind ${kind}`);
}
