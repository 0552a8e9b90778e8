// Shows in some seconds what there is to feel: presses, strokes, and two other materials. Ends at once when the
// person does anything.

import { Vector2 } from "three";
import type { Session } from "../model/session";
import type { SettingValue, ToProgram } from "../protocol/messages";
import type { Seen } from "../view/pick";
import type { Hand } from "./hand";
import type { Stroke } from "./stroke";

interface Part {
  words: string;
  seconds: number;
  wide: number; // how far it strokes to either side, of what the tour may
  preset?: string;
}

const kWidest = 0.15; // of the picture's half width, of a stroke to either side
const kReaches = 6; // of what is looked at around a pointer, so that a hand follows
const kParts: readonly Part[] = [
  { words: "The red hand presses. The black proxy stays on the surface: the spring between them is the force.", seconds: 5, wide: 0 },
  { words: "It strokes: the proxy follows the surface, and the force turns with it.", seconds: 6, wide: 1 },
  { words: "Soft: the same force goes deeper.", seconds: 5, wide: 0.5, preset: "soft" },
  { words: "Glass: stiff and smooth.", seconds: 5, wide: 0.5, preset: "glass" },
];
const kLast = "Now you: press on the surface, and use the wheel for more force.";
const kLastSeconds = 5;
const kLift = 0.8; // s at the beginning of a part in which it hovers
const kTurn = 6; // s of a stroke to and fro
const kDoings = ["pointerdown", "keydown", "wheel"] as const;
const kRings = 6; // around the middle of the picture in which a surface is looked for
const kPlaces = 12;
const kNear = 0.02; // of the half picture, to tell how far that is
const kFarthest = 0.8; // of the half picture
const kTurned = 0.7; // cosine between normals of one stroke
const kSteep = 0.5; // of its length that a stroke goes down or up

export class Tour {
  private begun: number | undefined; // ms, of the part
  private part = 0;
  private readonly middle = new Vector2();
  private wide = 0; // of the picture's half width
  private before = new Map<string, SettingValue>();
  private usual = new Map<string, SettingValue>(); // those of the preset `default`, once they are known

  constructor(
    private readonly session: Session,
    private readonly hand: Hand,
    private readonly stroke: Stroke,
    private readonly take: () => boolean,
    private readonly send: (message: ToProgram) => void,
    private readonly say: (words: string) => void,
  ) {}

  /** False where there is nothing to touch or the tool cannot be taken. */
  start(now: number): boolean {
    this.stop();
    if (!this.findPlace() || !this.take()) return false;
    this.before = new Map(this.session.values);
    this.usual.clear();
    this.stroke.rest(); // with the force that it begins with
    this.stroke.led = true;
    for (const type of kDoings) window.addEventListener(type, this.disturb, { capture: true });
    this.begin(0, now);
    return true;
  }

  /** Leaves the settings as they were. */
  stop(): void {
    if (this.begun === undefined) return;
    for (const type of kDoings) window.removeEventListener(type, this.disturb, { capture: true });
    this.begun = undefined;
    this.say("");
    this.stroke.rest();
    this.hand.letGo();
    this.preset("default");
    for (const [key, value] of this.before) {
      if (this.usual.get(key) !== value) this.send({ type: "set", key, value });
    }
  }

  /** Before every picture; `now` in ms. */
  update(now: number): void {
    if (this.begun === undefined) return;
    if (!this.hand.held || !this.stroke.led) return this.stop();
    const part = kParts[this.part];
    const passed = (now - this.begun) / 1000;
    if (passed > (part?.seconds ?? kLastSeconds)) {
      if (part === undefined) this.stop();
      else this.begin(this.part + 1, now);
      return;
    }
    const aside = this.wide * (part?.wide ?? 0) * Math.sin((2 * Math.PI * passed) / kTurn);
    const at = this.middle.clone().setX(this.middle.x + aside);
    if (this.stroke.under(at, false) !== undefined) this.stroke.aim(at, false);
    this.stroke.press(part !== undefined && passed > kLift);
    if (this.part === 0 && passed > kLift) this.usual = new Map(this.session.values);
  }

  private begin(part: number, now: number): void {
    this.part = part;
    this.begun = now;
    this.say(kParts[part]?.words ?? kLast);
    this.preset(kParts[part]?.preset ?? "default");
  }

  private preset(name: string): void {
    if (this.session.welcome?.presets.includes(name)) this.send({ type: "preset", name });
  }

  /** The button and the key that let the tool go end it by that. */
  private readonly disturb = (event: Event): void => {
    const button = (event.target as Partial<Element> | null)?.closest?.("#take") ?? null;
    if (button === null && (event as Partial<KeyboardEvent>).key !== "t") this.stop();
  };

  /** Nearest to the middle of the picture, of places that can be stroked if there is one. */
  private findPlace(): boolean {
    const places: Vector2[] = [];
    for (let ring = 0; ring < kRings; ring += 1) {
      for (let k = 0; k < (ring === 0 ? 1 : kPlaces); k += 1) {
        const angle = (2 * Math.PI * k) / kPlaces;
        places.push(new Vector2(Math.cos(angle), Math.sin(angle)).multiplyScalar((kFarthest * ring) / kRings));
      }
    }
    const found = places.find((at) => this.goesOn(at)) ?? places.find((at) => this.stroke.under(at, false) !== undefined);
    if (found === undefined) return false;
    this.middle.copy(found);
    this.wide = this.wideAt(found);
    return true;
  }

  private beside(at: Vector2, way: number): Seen | undefined {
    return this.stroke.under(new Vector2(at.x + way, at.y), false);
  }

  private wideAt(at: Vector2): number {
    const [middle, beside] = [this.beside(at, 0), this.beside(at, kNear)];
    if (middle === undefined || beside === undefined) return kNear;
    return Math.min(kWidest, (kReaches * middle.reach * kNear) / beside.place.distanceTo(middle.place));
  }

  /** Is this one surface, seen from above, as far as strokes go? */
  private goesOn(at: Vector2): boolean {
    const wide = this.wideAt(at);
    const seen = [0, -0.5, 0.5, -1, 1].map((part) => this.beside(at, part * wide));
    const middle = seen[0];
    return middle !== undefined && seen.every((other) => {
      if (other === undefined || other.normal.dot(middle.normal) < kTurned) return false;
      const way = other.place.clone().sub(middle.place);
      return Math.abs(way.dot(middle.normal)) < kSteep * way.length() + middle.reach;
    });
  }
}
