// The tool on the surface under a pointer: it hovers there while it is held, presses while a button is
// down, and goes in front of what lies between where the surface ends and another begins.

import { Plane, Raycaster, Vector2, Vector3 } from "three";
import type { Seen } from "../view/pick";
import type { World } from "../view/world";
import type { Hand } from "./hand";

const kBetween = [0.25, 0.5, 0.75]; // of the way, where it looks for what is in between
const kPatience = 500; // ms between two ways out of a surface's back
const kFirst = 1; // N, at which a press begins
const kLeast = 0.1;
const kMost = 5;
const kNotch = 1.25; // times the force, a notch of the wheel
const kGain = 4; // of what the force lacks, a second
const kDeepest = 4; // times as deep as the force wants: what the hand's own spring takes, and a soft start
const kGrazing = 0.25; // cosine: a plane seen flatter says nothing of where the pointer is on it
const kAbove = 2; // reaches of a pick, where it hovers, and how much deeper than the points it searches
const kSearch = 0.3; // s a reach
const kPointer = 6; // pixels around a mouse in which a surface counts
const kFinger = 14;
const kLongest = 0.1; // s between two states that count

export class Stroke {
  force = kFirst; // N, that a press wants
  private at: Vector2 | undefined; // the pointer in the picture, -1 to 1
  private finger = false;
  private pressing = false;
  private sunk = 0; // m, below the surface
  private inFront = false; // of it: from there alone it presses, and as deep as it searches
  private last: Seen | undefined;
  private before = 0; // ms
  private left = -Infinity; // ms, from behind a surface
  private readonly caster = new Raycaster();

  /** stiffness: of the surface, as it is set, N/m; putToHand: moves the proxy to the hand. */
  constructor(
    private readonly world: World,
    private readonly hand: Hand,
    private readonly stiffness: () => number,
    private readonly putToHand: () => void,
  ) {}

  get active(): boolean {
    return this.at !== undefined && this.hand.held;
  }

  /** Is there a surface at a place of the picture? */
  meets(at: Vector2, finger: boolean): boolean {
    return this.under(at, finger) !== undefined;
  }

  aim(at: Vector2, finger: boolean): void {
    this.at = at;
    this.finger = finger;
  }

  press(on: boolean): void {
    this.pressing = on;
  }

  /** Of a wheel, and of a pen that feels how hard it is pressed. */
  harder(notches: number): void {
    this.force = Math.min(kMost, Math.max(kLeast, this.force * kNotch ** notches));
  }

  /** Something else moves the tool. */
  rest(): void {
    this.at = undefined;
    this.pressing = false;
    this.inFront = false;
  }

  /** At every state of the tool, which come more evenly than pictures; `now` in ms. */
  update(now: number): void {
    const passed = Math.min(kLongest, Math.max(0, (now - this.before) / 1000));
    this.before = now;
    if (!this.active) return;
    const tool = this.world.tools[this.hand.device];
    if (tool === undefined) return;
    const seen = this.under(this.at!, this.finger);
    this.last = seen ?? this.beside() ?? this.last;
    if (this.last === undefined) return;
    const { place, normal, reach, inward } = this.last;
    const tangent = tool.touching ? this.tangent(tool.proxyPlace, tool.normal)?.add(inward) : undefined;
    const felt = tangent !== undefined && tangent.distanceTo(place) < kAbove * reach;
    if (felt) {
      place.copy(tangent);
      normal.copy(tool.normal);
    }
    const height = tool.hipPlace.clone().sub(place).dot(normal);
    if (tool.touching && height > 0 && tool.normal.dot(this.caster.ray.direction) > kGrazing) this.leaveBack(now);
    if (felt || height > reach / 2) this.inFront = true;
    else if (height < -this.deepest(reach)) this.inFront = false;
    const pressing = this.pressing && this.inFront && seen !== undefined && !tool.behind;
    if (pressing) this.sunk = felt ? this.pressed(passed, tool.force.length()) : this.searched(passed, reach);
    else this.sunk = this.force / this.stiffness();
    const goal = place.clone().addScaledVector(normal, pressing ? -this.sunk : kAbove * reach);
    this.hand.moveTo(this.way(tool.hipPlace, goal, kAbove * reach));
  }

  /** The hand is in front of a surface that holds the proxy from behind. */
  private leaveBack(now: number): void {
    if (now - this.left < kPatience) return;
    this.left = now;
    this.putToHand();
  }

  private under(at: Vector2, finger: boolean): Seen | undefined {
    const { camera } = this.world.stage;
    camera.updateMatrixWorld(); // it may have moved since the last picture
    this.caster.setFromCamera(at, camera);
    return this.world.surfaceAlong(this.caster.ray, finger ? kFinger : kPointer);
  }

  /** Where there is no surface: as far away as the last one was. */
  private beside(): Seen | undefined {
    if (this.last === undefined) return undefined;
    const forward = this.world.stage.camera.getWorldDirection(new Vector3());
    const plane = new Plane().setFromNormalAndCoplanarPoint(forward, this.last.place);
    const place = this.caster.ray.intersectPlane(plane, new Vector3());
    return place === null ? undefined : { place, normal: forward.negate(), reach: this.last.reach, inward: new Vector3() };
  }

  /** What the pointer shows of the plane that holds the proxy: finer than points are. */
  private tangent(proxy: Vector3, normal: Vector3): Vector3 | undefined {
    const { ray } = this.caster;
    if (-normal.dot(ray.direction) < kGrazing) return undefined;
    return ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, proxy), new Vector3()) ?? undefined;
  }

  /** How deep leads to the force that is wanted, after some seconds of another, m. */
  private pressed(seconds: number, force: number): number {
    const unit = this.force / this.stiffness();
    const before = Math.min(this.sunk, kDeepest * unit); // it may have searched deeper
    return Math.max(0, before + kGain * seconds * (1 - force / this.force) * unit);
  }

  /** Deeper: what is felt is where points show it to within their reach. */
  private searched(seconds: number, reach: number): number {
    return Math.min(this.sunk + (seconds * reach) / kSearch, 1.1 * this.deepest(reach));
  }

  private deepest(reach: number): number {
    return this.force / this.stiffness() + kAbove * reach;
  }

  /** Straight to a goal; where that is much nearer or farther than it is aside, or something is between, in front of it. */
  private way(from: Vector3, goal: Vector3, slack: number): Vector3 {
    const { camera } = this.world.stage;
    const eye = camera.position;
    const forward = camera.getWorldDirection(new Vector3());
    const depth = (place: Vector3) => place.clone().sub(eye).dot(forward);
    const [here, there] = [depth(from), depth(goal)];
    const aside = from.clone().sub(eye).projectOnPlane(goal.clone().sub(eye).normalize()).length();
    if (aside < slack) return goal;
    const between = aside < 2 * slack ? Infinity : Math.min(...kBetween.map((part) => this.depthAt(from, goal, part, depth)));
    const nearest = Math.min(here, there);
    if (Math.abs(here - there) < aside + slack && between > nearest - slack / 2) return goal;
    const front = Math.min(nearest, between) - slack;
    const through = here - front > slack ? from : goal;
    return eye.clone().addScaledVector(through.clone().sub(eye), front / depth(through));
  }

  /** Of what is seen between two places. */
  private depthAt(from: Vector3, to: Vector3, part: number, depth: (place: Vector3) => number): number {
    const { camera } = this.world.stage;
    const at = from.clone().project(camera).lerp(to.clone().project(camera), part);
    const seen = this.under(new Vector2(at.x, at.y), this.finger);
    return seen === undefined ? Infinity : depth(seen.place);
  }
}
