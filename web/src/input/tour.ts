// Shows in some seconds what there is to feel: presses, strokes, and two of the presets' materials. Ends at once when the
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
  stiffer?: number; // times what it was
  friction?: number;
}

const kWidest = 0.15; // of the picture's half width, of a stroke to either side
const kReaches = 6; // of what is looked at around a pointer, so that a hand follows
const kParts: readonly Part[] = [
  { words: "The red hand presses. The black proxy stays on the surface: the spring between them is the force.", seconds: 5, wide: 0 },
  { words: "It strokes: the proxy follows the surface, and the force turns with it.", seconds: 6, wide: 1 },
  { words: "Fur: the same force goes deeper, and a stroke is held back.", seconds: 5, wide: 0.5, stiffer: 0.3, friction: 0.5 },
  { words: "Ice: stiff and slippery.", seconds: 5, wide: 0.5, stiffer: 2.4, friction: 0.02 },
];
const kLast = "Now you: press on the surface, and use the wheel for more force.";
const kLastSeconds = 5;
const kLift = 0.8; // s at the beginning of a part in which it hovers
const kTurn = 6; // s of a stroke to and fro
// The first two before others receive them; keys after them, since one lets the tool go by itself.
const kDoings = [["pointerdown", true], ["wheel", true], ["keydown", false]] as const;
const kRings = 6; // around the middle of the picture in which a surface is looked for
const kAngles = 8; // around a ring
const kNear = 0.02; // of the half picture, to measure how far that is on the surface
const kFarthest = 0.8; // of the half picture
const kTurned = 0.7; // cosine between normals of one stroke
const kSteep = 0.5; // of its length that a stroke goes down or up

export class Tour {
  private begun: number | undefined; // ms, of the part
  private part = 0;
  private readonly middle = new Vector2();
  private wide = 0; // of the picture's half width
  private readonly before = new Map<string, SettingValue>(); // of what it has set and not put back

  constructor(
    private readonly session: Session,
    private readonly hand: Hand,
    private readonly stroke: Stroke,
    private readonly take: () => boolean,
    private readonly send: (message: ToProgram) => boolean,
    private readonly say: (words: string) => void,
  ) {}

  /** False where there is nothing to touch or the tool cannot be taken. */
  start(now: number): boolean {
    this.stop();
    if (!this.findMiddle() || !this.take()) return false;
    this.stroke.rest(); // with the force that it begins with
    this.stroke.led = true;
    for (const [type, capture] of kDoings) window.addEventListener(type, this.disturb, { capture });
    this.begin(0, now);
    return true;
  }

  /** Leaves the settings as they were. */
  stop(): void {
    if (this.begun === undefined) return;
    for (const [type, capture] of kDoings) window.removeEventListener(type, this.disturb, { capture });
    this.begun = undefined;
    this.say("");
    this.stroke.rest();
    this.hand.letGo();
    this.putBack();
  }

  /** What a lost connection kept it from. */
  putBack(): void {
    if (this.begun !== undefined) return;
    for (const [key, value] of this.before) {
      if (this.send({ type: "set", key, value })) this.before.delete(key);
    }
  }

  /** Another run: nothing is left to put back. */
  forget(): void {
    this.before.clear();
    this.stop();
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
  }

  private begin(part: number, now: number): void {
    this.part = part;
    this.begun = now;
    this.say(kParts[part]?.words ?? kLast);
    const { stiffer = 1, friction } = kParts[part] ?? {};
    this.set("stiffness", (before) => stiffer * before);
    this.set("friction", (before) => friction ?? before);
  }

  /** Sets a number to what is made of the one before the tour, within its bounds. */
  private set(key: string, make: (before: number) => number): void {
    const { least = 0, most = Infinity } = this.session.welcome?.settings.find((one) => one.key === key) ?? {};
    const now = this.session.values.get(key);
    const before = this.before.get(key) ?? now;
    if (typeof before !== "number") return;
    const value = Math.min(most, Math.max(least, make(before)));
    if (value === now || !this.send({ type: "set", key, value })) return;
    if (value === before) this.before.delete(key);
    else this.before.set(key, before);
  }

  /** The button that lets the tool go ends it by that. */
  private readonly disturb = (event: Event): void => {
    const button = (event.target as Partial<Element> | null)?.closest?.("#take") ?? null;
    if (button === null) this.stop();
  };

  /** Sets `middle` to the candidate nearest to the picture's middle, preferably one whose strokes stay on the surface. */
  private findMiddle(): boolean {
    const candidates: Vector2[] = [];
    for (let ring = 0; ring < kRings; ring += 1) {
      for (let k = 0; k < (ring === 0 ? 1 : kAngles); k += 1) {
        const angle = (2 * Math.PI * k) / kAngles;
        candidates.push(new Vector2(Math.cos(angle), Math.sin(angle)).multiplyScalar((kFarthest * ring) / kRings));
      }
    }
    let found = false;
    for (const at of candidates) {
      const seen = this.beside(at, 0);
      if (seen === undefined) continue;
      const wide = this.wideAt(at, seen);
      const good = this.goesOn(at, seen, wide);
      if (found && !good) continue;
      found = true;
      this.middle.copy(at);
      this.wide = wide;
      if (good) break;
    }
    return found;
  }

  private beside(at: Vector2, shift: number): Seen | undefined {
    return this.stroke.under(new Vector2(at.x + shift, at.y), false);
  }

  private wideAt(at: Vector2, middle: Seen): number {
    const beside = this.beside(at, kNear);
    if (beside === undefined) return kNear;
    return Math.min(kWidest, (kReaches * middle.reach * kNear) / beside.position.distanceTo(middle.position));
  }

  /** Is this one surface, seen from above, as far as strokes go? */
  private goesOn(at: Vector2, middle: Seen, wide: number): boolean {
    return [-0.5, 0.5, -1, 1].every((part) => {
      const other = this.beside(at, part * wide);
      if (other === undefined || other.normal.dot(middle.normal) < kTurned) return false;
      const offset = other.position.clone().sub(middle.position);
      return Math.abs(offset.dot(middle.normal)) < kSteep * offset.length() + middle.reach;
    });
  }
}
