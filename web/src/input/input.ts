// Everything that moves the hand without a drag: keys, controllers, the two buttons for depth.

import type { World } from "../view/world";
import { Gamepads } from "./gamepad";
import type { Hand } from "./hand";
import type { Keys } from "./keys";
import type { SpaceMouse } from "./space_mouse";
import type { Stroke } from "./stroke";

const kKeyPace = 0.07; // of the picture's height a second
const kPadPace = 0.35;
const kButtonPace = 0.05;
const kTurnPace = 1.2; // rad a second (judgement)
const kOpenPace = 0.5; // extents of the tool a second (judgement)
const kLongest = 0.5; // s between two pictures that count

export class Input {
  depth = 0; // of the buttons: 1 away, -1 closer
  opening = 0; // of the buttons of a gripper: 1 opens, -1 closes
  private readonly pads = new Gamepads();
  private readonly before = [0, 0]; // buttons of the controllers, and of the 3D mouse
  private last = 0;

  constructor(
    private readonly world: World,
    private readonly hand: Hand,
    private readonly keys: Keys,
    private readonly spaceMouse: SpaceMouse,
    private readonly stroke: Stroke,
    private readonly take: () => boolean,
  ) {}

  update(now: number): void {
    const passed = Math.min(kLongest, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    this.usePads(passed);
    const [right, up, away, pitch, yaw, roll, open] = this.keys.take(now);
    if (!this.hand.held) {
      if (right !== 0 || up !== 0 || away !== 0) {
        this.world.navigation.turn(right, up, away);
      }
      return;
    }
    this.turn(pitch, yaw, roll, open + this.opening * passed);
    this.move(right * kKeyPace, up * kKeyPace, away * kKeyPace + this.depth * kButtonPace * passed);
  }

  private usePads(passed: number): void {
    const readings = [this.pads.read(), this.spaceMouse.read()];
    let buttons = 0;
    readings.forEach((reading, i) => {
      if (reading === undefined) return;
      buttons |= reading.buttons;
      const pressed = reading.buttons & ~this.before[i]!;
      this.before[i] = reading.buttons;
      if ((pressed & 1) !== 0 && !this.hand.held) this.take();
      else if ((pressed & 2) !== 0) this.hand.letGo();
      if (!this.hand.held) return;
      const step = kPadPace * passed;
      this.move(reading.right * step, reading.up * step, (this.hand.turned ? reading.depth : reading.away) * step);
      const [pitch, yaw, roll] = reading.turn;
      this.turn(pitch * passed, yaw * passed, roll * passed, reading.open * passed);
    });
    if (this.hand.held && readings.some((reading) => reading !== undefined)) this.hand.press(buttons & ~3);
  }

  /** For so many seconds. */
  private turn(pitch: number, yaw: number, roll: number, open: number): void {
    this.hand.turn(this.world.stage.camera, pitch * kTurnPace, yaw * kTurnPace, roll * kTurnPace);
    this.hand.open(open * kOpenPace);
  }

  /** In heights of the picture. */
  private move(right: number, up: number, away: number): void {
    if (right === 0 && up === 0 && away === 0) return;
    this.stroke.rest();
    const { stage } = this.world;
    const height = stage.pixelAt(this.hand.position) * stage.height;
    this.hand.nudge(stage.camera, right * height, up * height, away * height);
  }
}
