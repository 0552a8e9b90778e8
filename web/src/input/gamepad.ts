// Game controllers, and space mice that browsers show as such. Polled: there are no events for axes.

export interface PadReading {
  right: number; // -1 to 1
  up: number;
  away: number;
  buttons: number; // bits
}

const kDead = 0.12;
const kSpaceMouse = /3dconnexion|space\s?(mouse|navigator|pilot|explorer)/i;

/** Nothing inside the dead zone, then from 0 on, finer near the middle. */
export function bend(value: number): number {
  const over = Math.abs(value) - kDead;
  return over <= 0 ? 0 : Math.sign(value) * (over / (1 - kDead)) ** 1.6;
}

/** Left stick: in the plane of the view; right stick: depth. */
export function readPad(pad: Pick<Gamepad, "id" | "axes" | "buttons">): PadReading {
  const axis = (i: number) => bend(pad.axes[i] ?? 0);
  const buttons = pad.buttons.reduce((bits, b, i) => (b.pressed && i < 31 ? bits | (1 << i) : bits), 0);
  if (kSpaceMouse.test(pad.id)) return { right: axis(0), up: -axis(2), away: -axis(1), buttons };
  return { right: axis(0), up: -axis(1), away: -axis(3), buttons };
}

export class Gamepads {
  /** All of them together; undefined where there is none. */
  read(): PadReading | undefined {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad?.connected);
    if (pads.length === 0) return undefined;
    const sum: PadReading = { right: 0, up: 0, away: 0, buttons: 0 };
    for (const pad of pads) {
      const one = readPad(pad!);
      sum.right += one.right;
      sum.up += one.up;
      sum.away += one.away;
      sum.buttons |= one.buttons;
    }
    return sum;
  }
}
