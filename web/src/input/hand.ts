// The hand of this page: where it wants the tool to be. It is held from `take` on until `letGo`; the
// program receives every move, but no more often than it reads messages.

import { Vector3, type PerspectiveCamera } from "three";
import type { ToProgram } from "../protocol/messages";

const kInterval = 8; // ms: 125 messages a second at most

export class Hand {
  held = false;
  device = 0;
  readonly position = new Vector3();
  private force: number | undefined; // N, that it pulls with at most; undefined: as hard as it can
  private buttons = 0;
  private sent = -Infinity;
  private timer = 0;

  constructor(
    private readonly send: (message: ToProgram) => void,
    private readonly changed: () => void,
  ) {}

  take(device: number, position: Vector3): void {
    this.device = device;
    this.position.copy(position);
    this.held = true;
    this.force = undefined;
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
    this.mark();
  }

  /** Right, up and away as the eye sees them, m. */
  nudge(camera: PerspectiveCamera, right: number, up: number, away: number): void {
    if (!this.held || (right === 0 && up === 0 && away === 0)) return;
    this.force = undefined;
    this.position.add(new Vector3(right, up, -away).applyQuaternion(camera.quaternion));
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
    });
  }
}
