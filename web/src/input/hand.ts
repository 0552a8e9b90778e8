// The hand of this page: where it wants the tool to be, and who hears of it. It is held from `take` on
// until `letGo`; while it rests, its place is repeated now and then.

import { Vector3, type PerspectiveCamera } from "three";
import type { ToProgram } from "../protocol/messages";

const kInterval = 8; // ms: 125 messages a second at most
const kRepeat = 200; // ms

export class Hand {
  held = false;
  device = 0;
  readonly place = new Vector3();
  private buttons = 0;
  private dirty = false;
  private sent = -Infinity;
  private timer = 0;

  constructor(
    private readonly send: (message: ToProgram) => void,
    private readonly changed: () => void,
  ) {}

  take(device: number, place: Vector3): void {
    this.device = device;
    this.place.copy(place);
    this.held = true;
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

  moveTo(place: Vector3): void {
    if (!this.held) return;
    this.place.copy(place);
    this.mark();
  }

  /** Right, up and away as the eye sees them, m. */
  nudge(camera: PerspectiveCamera, right: number, up: number, away: number): void {
    if (!this.held || (right === 0 && up === 0 && away === 0)) return;
    this.place.add(new Vector3(right, up, -away).applyQuaternion(camera.quaternion));
    this.mark();
  }

  press(buttons: number): void {
    if (buttons === this.buttons) return;
    this.buttons = buttons;
    this.mark();
  }

  private mark(): void {
    this.dirty = true;
    if (this.timer !== 0 && performance.now() - this.sent < kInterval) return;
    clearTimeout(this.timer);
    this.flush();
  }

  private flush(): void {
    this.timer = 0;
    if (!this.held) return;
    const now = performance.now();
    const due = this.sent + (this.dirty ? kInterval : kRepeat);
    if (now >= due) {
      this.send({
        type: "hand", device: this.device, position: this.place.toArray(), buttons: this.buttons,
      });
      this.sent = now;
      this.dirty = false;
    }
    this.timer = window.setTimeout(() => this.flush(), this.dirty ? kInterval : kRepeat);
  }
}
