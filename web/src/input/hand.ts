// The hand of this page: where it wants the tool to be. It is held from `take` on until `letGo`; the
// program receives every move, but no more often than it reads messages.

import { MathUtils, Quaternion, Vector3, type PerspectiveCamera } from "three";
import type { ToProgram } from "../protocol/messages";
import type { Tool } from "../view/tool";

const kInterval = 8; // ms: 125 messages a second at most
const kWidest = 2; // extents of its tool that a gripper opens at most: two fingers on either side of what is as large

export class Hand {
  held = false;
  device = 0;
  readonly position = new Vector3();
  turned: Quaternion | undefined; // of a tool that turns
  private opening = 0; // m
  private extent = 0; // of the tool from its handle, m
  private eye: Vector3 | undefined; // that sees the position, where the program leads the hand there
  private force: number | undefined; // N, that it pulls with at most; undefined: as hard as it can
  private buttons = 0;
  private sent = -Infinity;
  private timer = 0;

  constructor(
    private readonly send: (message: ToProgram) => void,
    private readonly changed: () => void,
  ) {}

  /** A tool that turns begins as the hand has it. */
  take(device: number, tool: Pick<Tool, "hipPosition" | "shape" | "turn" | "opening">): void {
    this.device = device;
    this.position.copy(tool.hipPosition);
    this.turned = tool.shape && tool.turn.clone();
    this.extent = tool.shape?.extent ?? 0;
    this.opening = tool.opening;
    this.held = true;
    this.force = this.eye = undefined;
    this.mark();
    this.changed();
  }

  letGo(): void {
    if (!this.held) return;
    this.held = false;
    clearTimeout(this.timer);
    this.timer = 0;
    this.send({ type: "release", device: this.device });
    this.changed();
  }

  moveTo(position: Vector3, force?: number): void {
    if (!this.held || !Number.isFinite(position.lengthSq())) return;
    this.position.copy(position);
    this.force = force;
    this.eye = undefined;
    this.mark();
  }

  /** The program takes it there: through free space or, with a force, down onto it. */
  goTo(position: Vector3, eye: Vector3, force?: number): void {
    if (!this.held || !Number.isFinite(position.lengthSq() + eye.lengthSq())) return;
    this.position.copy(position);
    this.force = force;
    this.eye = eye.clone();
    this.mark();
  }

  /** Right, up and away as the eye sees them, m. */
  nudge(camera: PerspectiveCamera, right: number, up: number, away: number): void {
    if (!this.held || (right === 0 && up === 0 && away === 0)) return;
    this.force = this.eye = undefined;
    this.position.add(new Vector3(right, up, -away).applyQuaternion(camera.quaternion));
    this.mark();
  }

  /** About the directions right, up and towards the eye as it sees them, rad. */
  turn(camera: PerspectiveCamera, right: number, up: number, towards: number): void {
    const angle = Math.hypot(right, up, towards);
    if (!this.held || this.turned === undefined || !(angle > 0) || !Number.isFinite(angle)) return;
    const axis = new Vector3(right, up, towards).divideScalar(angle).applyQuaternion(camera.quaternion);
    this.turned.premultiply(new Quaternion().setFromAxisAngle(axis, angle)).normalize();
    this.mark();
  }

  /** By so many extents of the tool; negative: closer. */
  open(extents: number): void {
    if (!this.held || this.turned === undefined || extents === 0) return;
    this.opening = MathUtils.clamp(this.opening + extents * this.extent, 0, kWidest * this.extent);
    this.mark();
  }

  press(buttons: number): void {
    if (buttons === this.buttons) return;
    this.buttons = buttons;
    this.mark();
  }

  private mark(): void {
    const wait = this.sent + kInterval - performance.now();
    if (wait <= 0) this.report();
    else if (this.timer === 0) this.timer = window.setTimeout(() => this.report(), wait + 1);
  }

  private report(): void {
    clearTimeout(this.timer);
    this.timer = 0;
    if (!this.held) return;
    this.sent = performance.now();
    this.send({
      type: "hand", device: this.device, position: this.position.toArray(), buttons: this.buttons,
      ...(this.force === undefined ? {} : { force: this.force }),
      ...(this.eye === undefined ? {} : { eye: this.eye.toArray() }),
      ...(this.turned === undefined ? {} : { orientation: this.turned.toArray(), opening: this.opening }),
    });
  }
}
