// The tool in the manner of Leeper, Chan and Salisbury's figures: the proxy a dark sphere, the
// constraint's tangent plane a green disk, the hand (HIP) light red, the force an arrow. A free hand has a
// line to the nearest surface, and a ring on that.

import {
  CircleGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, Quaternion, RingGeometry, SphereGeometry, Vector3, Vector4, type Camera, type Material,
} from "three";
import type { StateMessage, ToolMessage } from "../protocol/decode";
import { Flag } from "../protocol/decode";
import type { Caster } from "./backdrop";
import { colourOf, handColour } from "./colours";
import { HaloMaterial } from "./halo";
import { ToolShape } from "./tool_shape";
import { Trail } from "./trail";

const kUp = new Vector3(0, 1, 0);
const kForward = new Vector3(0, 0, 1);
const kProxyPixels = 9;
const kHandPixels = 7.5;
const kLongest = 240; // pixels of an arrow
const kLeastForce = 0.01; // N that shows
const kStylus = 90; // pixels from the tip to its end
const kEndOn = 0.85; // cosine between the arrow and the direction to the eye, from which on it is seen end on
const kRingPixels = 30; // radius of the ring of an arrow that is seen end on, at most
const kFirm = 2; // N, that lets the dent glow by 63 %
const kShadow = 1.6; // of its ball, where its shadow is half as dark (judgement)
const kEdge = 0.94; // of the half picture, where an arrow ends (judgement)
const kSides = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([x, y]) => new Vector4(x, y, 0, kEdge)); // inner products are above 0 inside
const kRing = 11; // pixels, the ring below a free hand

function ball(material: Material, order: number): Mesh {
  const mesh = new Mesh(new SphereGeometry(1, 32, 20), material);
  mesh.renderOrder = order;
  return mesh;
}

function ghostOf(material: MeshLambertMaterial, opacity: number): MeshBasicMaterial {
  const ghost = new MeshBasicMaterial({
    transparent: true, opacity, depthTest: false, depthWrite: false,
  });
  ghost.color = material.color; // shared: it follows the theme
  return ghost;
}

/** A rod from one point to another, shown if it is long enough, m. */
function place(rod: Mesh, from: Vector3, to: Vector3, thickness: number, least: number): void {
  const offset = to.clone().sub(from);
  const length = offset.length();
  rod.visible = length > least;
  if (!rod.visible) return;
  rod.position.copy(from).addScaledVector(offset, 0.5);
  rod.quaternion.setFromUnitVectors(kUp, offset.divideScalar(length));
  rod.scale.set(thickness, length, thickness);
}

/** How much of the segment from a point in the picture to another stays in it, 0 to 1. */
export function shareInPicture(camera: Camera, from: Vector3, to: Vector3): number {
  const [a, b] = [from, to].map(({ x, y, z }) =>
    new Vector4(x, y, z).applyMatrix4(camera.matrixWorldInverse).applyMatrix4(camera.projectionMatrix)) as [Vector4, Vector4];
  const shares = kSides.map((side) => {
    const [near, far] = [a.dot(side), b.dot(side)];
    return far < 0 ? Math.max(0, near / (near - far)) : 1;
  });
  return Math.min(...shares);
}

export interface Sizes {
  pixel: number; // the length of one at the tool, m
  perNewton: number; // the arrow's length, m
  camera: Camera;
  lift: number; // of disk and proxy towards the eye, above the points, m
}

export class Tool {
  readonly group = new Group();
  readonly trail = new Trail();
  readonly hipPosition = new Vector3();
  readonly proxyPosition = new Vector3();
  showSupport = true;
  touching = false;
  behind = false; // what a camera sees
  weak = false; // the force is less than the surface's, until the tool has been lifted
  faulty = false; // no force until somebody resets
  readonly force = new Vector3(); // N, on the hand
  opening = 0; // of a gripper, that the hand asks for, m
  readonly normal = new Vector3(); // of the tangent constraint
  shape: ToolShape | undefined; // of a tool that turns, in the place of a point
  below: { point: Vector3; spacing: number } | undefined; // the nearest point of the surface, while the hand is free
  private readonly handMaterial = new MeshLambertMaterial();
  private readonly proxyMaterial = new MeshLambertMaterial();
  private readonly forceMaterial = new MeshLambertMaterial({ emissiveIntensity: 0.35 });
  private readonly diskMaterial = new MeshBasicMaterial({
    side: DoubleSide, transparent: true, opacity: 0.5, depthWrite: false,
  });
  private readonly rimMaterial = new MeshBasicMaterial({
    side: DoubleSide, transparent: true, opacity: 0.95, depthWrite: false,
  });
  private readonly springMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.8 });
  private readonly ringMaterial = new MeshBasicMaterial({
    side: DoubleSide, depthTest: false, depthWrite: false, transparent: true, opacity: 0.8,
  });
  private readonly endOnMaterial = new MeshBasicMaterial({ depthTest: false, depthWrite: false, transparent: true });
  private readonly haloMaterial = new HaloMaterial();
  private readonly hand = ball(this.handMaterial, 4);
  private readonly handGhost = ball(ghostOf(this.handMaterial, 0.7), 6);
  private readonly proxy = ball(this.proxyMaterial, 4);
  private readonly proxyGhost = ball(ghostOf(this.proxyMaterial, 0.35), 5);
  private readonly halo = ball(this.haloMaterial, 3);
  private readonly disk = new Mesh(new CircleGeometry(1, 64), this.diskMaterial);
  private readonly rim = new Mesh(new RingGeometry(0.95, 1, 64), this.rimMaterial);
  private readonly spring = new Mesh(new CylinderGeometry(1, 1, 1, 8), this.springMaterial);
  private readonly stylus = new Mesh(new CylinderGeometry(1, 0.4, 1, 12), this.handMaterial);
  private readonly drop = new Mesh(new CylinderGeometry(1, 1, 1, 8), this.springMaterial);
  private readonly ring = new Mesh(new RingGeometry(0.72, 1, 48), this.ringMaterial);
  private readonly shaft = new Mesh(new CylinderGeometry(1, 1, 1, 16), this.forceMaterial);
  private readonly head = new Mesh(new ConeGeometry(1, 1, 24), this.forceMaterial);
  private readonly endOn = new Mesh(new RingGeometry(0.9, 1, 48), this.endOnMaterial);
  readonly turn = new Quaternion(); // of the hand
  private readonly stem = new Vector3(); // from the tip along the stylus, 1 long; 0: unknown
  private radius = 0;

  constructor(private readonly device: number) {
    this.disk.renderOrder = 2;
    this.rim.renderOrder = 2;
    this.spring.renderOrder = 4;
    this.group.add(
      this.halo, this.disk, this.rim, this.spring, this.drop, this.ring, this.stylus, this.shaft, this.head, this.endOn,
      this.hand, this.handGhost, this.proxy, this.proxyGhost, this.trail.line,
    );
    this.group.visible = false;
    this.retint();
  }

  retint(): void {
    const hand = colourOf(handColour(this.device));
    this.handMaterial.color.copy(hand);
    this.proxyMaterial.color.copy(colourOf("--proxy"));
    this.forceMaterial.color.copy(colourOf("--force"));
    this.forceMaterial.emissive.copy(colourOf("--force"));
    this.endOnMaterial.color.copy(colourOf("--force"));
    this.diskMaterial.color.copy(colourOf("--disk"));
    this.rimMaterial.color.copy(colourOf("--disk"));
    this.springMaterial.color.copy(hand);
    this.ringMaterial.color.copy(hand);
    this.haloMaterial.tint(colourOf("--proxy"));
    this.trail.retint();
  }

  get support(): number {
    return this.radius;
  }

  takeShape(message: ToolMessage): void {
    if (this.shape !== undefined) this.group.remove(this.shape.proxy, this.shape.hand);
    this.shape?.dispose();
    this.shape = new ToolShape(message, this.proxyMaterial.color, this.handMaterial.color);
    this.group.add(this.shape.proxy, this.shape.hand);
  }

  /** How far what is held reaches from the proxy in a direction (unit), m. */
  reach(direction: Vector3): number {
    return this.shape?.reach(direction) ?? 0;
  }

  take(state: StateMessage): void {
    this.group.visible = true;
    this.hipPosition.set(...state.hip);
    this.proxyPosition.set(...state.proxy);
    this.force.set(...state.force);
    this.normal.set(...state.normal);
    if (state.orientation) this.turn.set(...state.orientation);
    this.stem.set(0, state.orientation && !state.tool ? -1 : 0, 0).applyQuaternion(this.turn);
    this.placeShape(state);
    this.radius = state.radius;
    this.touching = (state.flags & Flag.touching) !== 0;
    this.behind = (state.flags & Flag.behind) !== 0;
    this.weak = (state.flags & (Flag.starting | Flag.softer)) !== 0;
    this.faulty = (state.flags & Flag.fault) !== 0;
    this.trail.take(this.proxyPosition, state.time);
  }

  private placeShape({ tool }: StateMessage): void {
    if (this.shape === undefined || tool === undefined) return;
    this.opening = tool.handOpening;
    this.shape.placeProxy(this.proxyPosition, new Quaternion(...tool.orientation), tool.opening);
    this.shape.placeHand(this.hipPosition, this.turn, tool.handOpening);
  }

  update({ pixel, perNewton, camera, lift }: Sizes): void {
    const proxySize = Math.max(0.16 * this.radius, kProxyPixels * pixel);
    this.proxy.visible = this.touching && this.shape === undefined; // elsewhere it is where the hand is
    this.proxyGhost.visible = this.proxy.visible;
    if (this.shape !== undefined) this.shape.hand.visible = this.touching;
    const towards = camera.position.clone().sub(this.proxyPosition).normalize().multiplyScalar(lift);
    this.proxy.position.copy(this.proxyPosition).add(towards);
    this.proxy.scale.setScalar(proxySize);
    this.hand.position.copy(this.hipPosition);
    this.hand.scale.setScalar(Math.max(0.14 * this.radius, kHandPixels * pixel));
    this.proxyGhost.position.copy(this.proxy.position);
    this.proxyGhost.scale.copy(this.proxy.scale);
    this.handGhost.position.copy(this.hand.position);
    this.handGhost.scale.copy(this.hand.scale);
    this.halo.visible = this.showSupport && this.shape === undefined && this.radius > 2 * proxySize;
    this.halo.position.copy(this.proxyPosition);
    this.halo.scale.setScalar(Math.max(this.radius, 1e-9));
    this.placeDisk(Math.max(0.9 * this.radius, 2.8 * proxySize), towards);
    place(this.spring, this.hipPosition, this.proxyPosition, pixel, 2 * pixel);
    this.placeDrop(pixel);
    this.placeStylus(kStylus * pixel, pixel);
    this.placeArrow(proxySize, pixel, perNewton, camera);
  }

  private placeDisk(size: number, towards: Vector3): void {
    const hasNormal = this.touching && this.shape === undefined && // a tool that turns touches with several planes
      this.normal.lengthSq() > 0.5;
    this.disk.visible = hasNormal;
    this.rim.visible = hasNormal;
    if (!hasNormal) return;
    for (const mesh of [this.disk, this.rim]) {
      mesh.position.copy(this.proxyPosition).add(towards);
      mesh.quaternion.setFromUnitVectors(kForward, this.normal);
      mesh.scale.setScalar(size);
    }
  }

  /** The ball that is seen of it: the proxy in contact, else the hand. */
  get caster(): Caster {
    const ball = this.touching ? this.proxy : this.hand;
    return { position: this.touching ? this.proxyPosition : this.hipPosition, radius: kShadow * ball.scale.x, heat: this.heat };
  }

  /** How much its dent glows, 0 to 1. */
  get heat(): number {
    return this.touching ? 1 - Math.exp(-this.force.length() / kFirm) : 0;
  }

  /** How far it is to the surface, m; undefined where it is no farther than points are apart. */
  get height(): number | undefined {
    const { below } = this;
    const height = below === undefined || this.touching ? 0 : below.point.distanceTo(this.hipPosition);
    return below !== undefined && height > 2 * below.spacing ? height : undefined;
  }

  private placeDrop(pixel: number): void {
    const shown = this.height !== undefined;
    this.ring.visible = shown;
    if (!shown) {
      this.drop.visible = false;
      return;
    }
    const foot = this.below!.point;
    place(this.drop, this.hipPosition, foot, 0.6 * pixel, kRing * pixel);
    this.ring.position.copy(foot);
    this.ring.quaternion.setFromUnitVectors(kForward, this.hipPosition.clone().sub(foot).normalize());
    this.ring.scale.setScalar(kRing * pixel);
  }

  private placeStylus(length: number, pixel: number): void {
    this.stylus.visible = this.stem.lengthSq() > 0.5;
    if (!this.stylus.visible) return;
    this.stylus.position.copy(this.hipPosition).addScaledVector(this.stem, length / 2);
    this.stylus.quaternion.setFromUnitVectors(kUp, this.stem);
    this.stylus.scale.set(3.5 * pixel, length, 3.5 * pixel);
  }

  /** It ends in the picture. Where it points at the eye or away, a ring shows its length. */
  private placeArrow(start: number, pixel: number, perNewton: number, camera: Camera): void {
    const size = this.force.length();
    const shown = size > kLeastForce;
    this.shaft.visible = shown;
    this.head.visible = shown;
    this.endOn.visible = false;
    if (!shown) return;
    const along = this.force.clone().divideScalar(size);
    start = Math.max(start, this.reach(along));
    const longest = Math.min(size * perNewton, kLongest * pixel);
    const tip = this.proxyPosition.clone().addScaledVector(along, start + longest);
    const length = Math.max(longest * shareInPicture(camera, this.proxyPosition, tip), 10 * pixel);
    const headLength = Math.min(17 * pixel, 0.5 * length);
    const shaftLength = length - headLength;
    this.shaft.position.copy(this.proxyPosition).addScaledVector(along, start + shaftLength / 2);
    this.shaft.quaternion.setFromUnitVectors(kUp, along);
    this.shaft.scale.set(2.8 * pixel, shaftLength, 2.8 * pixel);
    this.head.position.copy(this.proxyPosition).addScaledVector(along, start + length - headLength / 2);
    this.head.quaternion.copy(this.shaft.quaternion);
    const towards = camera.position.clone().sub(this.proxyPosition).normalize();
    this.endOn.visible = Math.abs(along.dot(towards)) > kEndOn;
    this.endOn.position.copy(this.proxyPosition);
    this.endOn.quaternion.setFromUnitVectors(kForward, towards);
    this.endOn.scale.setScalar(Math.min(start + 0.5 * length, kRingPixels * pixel));
    this.head.scale.set(headLength * 0.45, headLength, headLength * 0.45);
  }
}
