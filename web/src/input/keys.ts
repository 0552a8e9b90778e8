// Keys. Those that move are held down; the others act once. None acts while one writes into a field.

/** What goes to and fro in a recording. */
export interface TimeKeys {
  toggle(): void;
  step(seconds: number): void;
}

export interface Actions {
  toggleTool(): void;
  toggleFree(): void;
  letGo(): void;
  togglePause(): void;
  reset(): void;
  fit(): void;
  follow(): void;
  turnUpright(): void;
  help(): void;
  freeze(): void;
  togglePanels(): void;
  sayForce(): void;
}

/** What keys that are held down do: right, up and away; turns about right, up and towards the eye; how a gripper opens. */
export type Held = [right: number, up: number, away: number, pitch: number, yaw: number, roll: number, open: number];

const kMoves: Record<string, readonly [axis: number, sign: number]> = {
  ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1], PageUp: [2, 1], PageDown: [2, -1],
  k: [3, 1], i: [3, -1], l: [4, 1], j: [4, -1], ",": [5, 1], ".": [5, -1], o: [6, 1], g: [6, -1],
};

const kFast = 4;
const kFine = 0.2;
const kStep = 1; // s of a recording
const kLongStep = 10;
const kShortStep = 0.05;
const kLongest = 0.5; // s that a key counts between two looks, however slow pictures are

export class Keys {
  single = true; // letters act by themselves
  timeLine: TimeKeys | undefined; // of a recording
  private readonly down = new Map<string, { name: string; since: number }>(); // by the key, which Shift changes nothing of; ms from when on its time is to be counted
  private held: Held = [0, 0, 0, 0, 0, 0, 0]; // s
  private pace = 1;

  constructor(actions: Actions) {
    const once: Record<string, () => void> = {
      t: () => actions.toggleTool(),
      m: () => actions.toggleFree(),
      p: () => actions.togglePause(),
      r: () => actions.reset(),
      f: () => actions.fit(),
      c: () => actions.follow(),
      u: () => actions.turnUpright(),
      h: () => actions.freeze(),
      a: () => actions.togglePanels(),
      s: () => actions.sayForce(),
      "?": () => actions.help(),
    };
    window.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && !dialogIsOpen()) actions.letGo();
      if (event.ctrlKey || event.metaKey || writes(event.target) || dialogIsOpen()) return;
      if (this.movesTime(event)) {
        event.preventDefault();
        return;
      }
      const act = event.altKey || !this.single ? undefined : once[event.key.toLowerCase()];
      if (act !== undefined && !event.repeat) act();
      else if (!this.press(event)) return;
      event.preventDefault();
    });
    window.addEventListener("keyup", (event) => {
      const key = event.code || nameOf(event);
      this.count(key, event.timeStamp);
      this.down.delete(key);
    });
    window.addEventListener("blur", () => this.down.clear());
  }

  /** For how long each was held down since the last look, s and times the pace. */
  take(now: number): Held {
    for (const key of this.down.keys()) this.count(key, now);
    const held = this.held;
    this.held = [0, 0, 0, 0, 0, 0, 0];
    return held;
  }

  private count(key: string, now: number): void {
    const held = this.down.get(key);
    if (held === undefined || now < held.since) return;
    const seconds = Math.min(kLongest, (now - held.since) / 1000);
    held.since = now;
    const [axis, sign] = kMoves[held.name]!;
    this.held[axis]! += sign * this.pace * seconds;
  }

  /** Arrows and the space bar, where a recording is shown; a button keeps its space bar. */
  private movesTime(event: KeyboardEvent): boolean {
    if (this.timeLine === undefined) return false;
    const direction = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const presses = event.target instanceof Element && event.target.closest("button, input[type='checkbox']") !== null;
    if (direction !== undefined) {
      this.timeLine.step(direction * (event.shiftKey ? kLongStep : event.altKey ? kShortStep : kStep));
    } else if (event.key === " " && !presses) {
      if (!event.repeat) this.timeLine.toggle();
    } else {
      return false;
    }
    return true;
  }

  private press(event: KeyboardEvent): boolean {
    const name = nameOf(event);
    if (kMoves[name] === undefined || (name.length === 1 && !this.single)) return false;
    if (event.target instanceof Element && event.target.closest(".side") !== null) return false;
    this.pace = event.shiftKey ? kFast : event.altKey ? kFine : 1;
    const key = event.code || name;
    if (!this.down.has(key)) this.down.set(key, { name, since: event.timeStamp });
    return true;
  }
}

/** A letter is the same with Shift. */
function nameOf({ key }: KeyboardEvent): string {
  return key.length === 1 ? key.toLowerCase() : key;
}

function writes(target: EventTarget | null): boolean {
  return target instanceof Element &&
    target.matches("input:not([type='checkbox'], [type='range']), select, textarea");
}

function dialogIsOpen(): boolean {
  return document.querySelector("dialog[open]") !== null;
}
