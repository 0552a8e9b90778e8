// The tool on the surface under a pointer: it hovers there while it is held, and presses while a button is
// down: the hand wants to be deep below the surface, but pulls with a limited force. Wherever it does not touch,
// the program leads it: to where it hovers, lifted and through free space, and down onto the surface.

import { MathUtils, Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Seen } from "../view/pick";
import type { Tool } from "../view/tool";
import type { World } from "../view/world";
import type { Hand } from "./hand";

const kFirst = 1; // N, of a press
const kLeast = 0.1;
const kMost = 5;
const kPen = 3; // of a pen that is pressed as hard as it can report
const kNotch = 1.25; // times the force, a notch of the wheel
const kAbove = 2; // reaches of a pick, where it hovers
const kBelow = 3; // and where a hand that presses wants to be at least
const kGive = 6; // times as deep as the surface yields to the force, as the hand's spring is not much softer
const kDeepest = 20; // times the least
const kSunk = 2; // reaches below what is seen, some 20 mm of the hand: a press that goes so deep, and is soft, ends
const kGrazing = 0.25; // cosine: a plane seen at a flatter angle does not determine where the pointer is on it
// ms in which a proxy that something else holds may come free, and a force that contact keeps small grow: a hand that
// nobody moves has to be lifted for that
const kPatience = 400;
const kEnough = 0.7; // of the force that is wanted; to be lifted is felt more than what is missing then
const kPointer = 6; // pixels around a mouse in which a surface counts
const kFinger = 14;

export class Stroke {
  private force = kFirst; // N
  private pen: number | undefined; // N, as it is pressed
  private at: Vector2 | undefined; // the pointer in the picture, -1 to 1
  private finger = false;
  private pressing = false;
  private content = false; // presses, and feels about the force that is wanted
  led = false; // by a tour, not by a pointer
  private misses = 0; // of a press, which went through what is seen
  private sunk = false; // too deep in what is soft; until it is out of it
  private there = false; // on the surface or above it: from there alone it presses
  private last: Seen | undefined;
  private good = 0; // ms, when nothing else held the proxy
  private strong = 0; // ms, when nothing kept the force small
  private freed = -Infinity; // ms
  private readonly caster = new Raycaster();

  /** free: puts the proxy to the hand. */
  constructor(private readonly world: World, private readonly hand: Hand, private readonly free: () => void) {}

  /** Is nothing felt where it presses on what is seen? Once may be a surface that it came to from below. */
  get nothing(): boolean {
    return this.misses > 1;
  }

  aim(at: Vector2, finger: boolean): void {
    this.at = at;
    this.finger = finger;
  }

  /** pressure: of a pen that reports it, 0 to 1. */
  press(on: boolean, pressure?: number): void {
    if (on && !this.pressing) this.there = false;
    this.pressing = on;
    this.pen = pressure === undefined ? undefined : Math.max(kLeast, kPen * pressure);
  }

  harder(notches: number): void {
    this.force = Math.min(kMost, Math.max(kLeast, this.force * kNotch ** notches));
  }

  /** Something else moves the tool. */
  rest(): void {
    const tool = this.world.tools[this.hand.device];
    if (this.pressing && tool !== undefined) this.hand.moveTo(tool.hipPosition); // not deep below a surface, with all force
    this.at = undefined;
    this.pressing = this.content = this.led = false;
    this.there = false;
    this.misses = 0;
    this.force = kFirst;
  }

  /** At every state of the tool, which come more evenly than pictures; `now` in ms. */
  update(now: number): void {
    const tool = this.world.tools[this.hand.device];
    if (this.at === undefined || !this.hand.held || tool === undefined) return;
    const seen = this.under(this.at, this.finger);
    this.last = seen ?? this.beside() ?? this.last;
    if (this.last === undefined) return;
    const felt = this.refine(this.last, tool);
    const { position, normal, reach } = this.last;
    const lift = tool.reach(normal.clone().negate()); // of the handle above what is lowest of the tool
    const above = position.clone().addScaledVector(normal, kAbove * reach + lift);
    this.content = this.pressing && tool.touching && tool.force.length() > kEnough * (this.pen ?? this.force);
    if (!this.pressing || tool.touching) this.misses = 0;
    this.judge(tool, above, felt, now);
    const pressing = this.pressing && this.there && seen !== undefined && !tool.behind;
    const eye = this.world.stage.camera.position;
    if (!pressing) this.hand.goTo(above, eye);
    else if (!tool.touching) this.hand.goTo(position.clone().addScaledVector(normal, lift - kBelow * reach), eye, this.pen ?? this.force);
    else this.hand.moveTo(position.clone().addScaledVector(normal, lift - this.depth(tool, reach)), this.pen ?? this.force);
  }

  /** m; so deep that the hand's spring pulls with all of the force. */
  private depth(tool: Tool, reach: number): number {
    const given = tool.proxyPosition.distanceTo(tool.hipPosition) / tool.force.length(); // m/N; NaN where nothing is touched
    const least = kBelow * reach;
    return MathUtils.clamp(kGive * (given || 0) * (this.pen ?? this.force), least, kDeepest * least);
  }

  /** Is the proxy on that side of that surface? Then its tangent plane locates the pointer more precisely than points do. */
  private refine({ position, normal, reach, inward }: Seen, tool: Tool): boolean {
    const facing = -tool.normal.dot(this.caster.ray.direction);
    if (!tool.touching || facing <= 0) return false;
    if (tool.shape !== undefined) return tool.proxyPosition.distanceTo(position) < tool.shape.extent + kAbove * reach; // some part of it touches
    const tangent = facing > kGrazing ? this.tangent(tool.proxyPosition, tool.normal)?.add(inward.clone().projectOnPlane(tool.normal)) : undefined;
    if ((tangent ?? tool.proxyPosition).distanceTo(position) > kAbove * reach) return false;
    if (tangent !== undefined) position.copy(tangent);
    normal.copy(tool.normal);
    return true;
  }

  /** Is the tool on the surface or above it? It has to go there if it is far off in depth, or has missed it. */
  private judge(tool: Tool, above: Vector3, felt: boolean, now: number): void {
    const { position, reach } = this.last!;
    const offset = position.clone().sub(this.foot(tool));
    const deep = Math.abs(offset.dot(this.caster.ray.direction));
    const aside = Math.sqrt(Math.max(0, offset.lengthSq() - deep * deep));
    const was = this.there;
    const far = aside > 2 * kAbove * reach;
    if (felt && (was || !far)) this.there = true;
    else if (this.missed(tool) || deep > aside + 2 * kAbove * reach || (far && !tool.touching)) this.there = false;
    else if (tool.hipPosition.distanceTo(above) < reach + (tool.shape?.extent ?? 0) / 4) this.there = true;
    this.sunk = tool.touching && (this.sunk || (tool.weak && this.below(tool) > kSunk * reach));
    if (this.sunk) this.there = false;
    if (!tool.touching || !tool.weak || this.content) this.strong = now;
    if (now - this.strong > kPatience) {
      this.there = false;
      this.freed = this.strong = now;
    }
    if (felt || !tool.touching) this.good = now;
    else if (now - this.good > kPatience) this.putToHand(now, tool.faulty);
    if (!was || this.there) return;
    if (this.missed(tool) && this.aside(tool) < reach) this.misses += 1;
  }

  /** Is the tool below the surface as deep as a press goes where nothing stops it? */
  private missed(tool: Tool): boolean {
    return this.below(tool) > 0.9 * kBelow * this.last!.reach;
  }

  /** How deep the hand is below the surface, m. */
  private below(tool: Tool): number {
    return this.last!.position.clone().sub(this.foot(tool)).dot(this.last!.normal);
  }

  /** Below the hand's handle, as low as the tool reaches; the hand itself, where it is a point. */
  private foot(tool: Tool): Vector3 {
    const { normal } = this.last!;
    return tool.hipPosition.clone().addScaledVector(normal, -tool.reach(normal.clone().negate()));
  }

  /** How far it has not gone straight through the surface, m. */
  private aside(tool: Tool): number {
    return tool.hipPosition.clone().sub(this.last!.position).projectOnPlane(this.last!.normal).length();
  }

  private putToHand(now: number, faulty: boolean): void {
    this.there = false;
    if (faulty || now - this.freed < kPatience / 4) return;
    this.freed = now;
    this.free();
  }

  /** The surface at a point of the picture. */
  under(at: Vector2, finger: boolean): Seen | undefined {
    const { camera } = this.world.stage;
    camera.updateMatrixWorld(); // it may have moved since the last picture
    this.caster.setFromCamera(at, camera);
    return this.world.surfaceAlong(this.caster.ray, finger ? kFinger : kPointer);
  }

  /** Where there is no surface: as far away as the last one was. */
  private beside(): Seen | undefined {
    if (this.last === undefined) return undefined;
    const forward = this.world.stage.camera.getWorldDirection(new Vector3());
    const position = this.tangent(this.last.position, forward);
    return position && { position, normal: forward.negate(), reach: this.last.reach, inward: new Vector3() };
  }

  /** What the pointer shows of a plane. */
  private tangent(position: Vector3, normal: Vector3): Vector3 | undefined {
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, position);
    return this.caster.ray.intersectPlane(plane, new Vector3()) ?? undefined;
  }
}
