// Game controllers, and space mice that browsers show as such. Polled: there are no events for axes.

export interface PadReading {
  right: number; // -1 to 1
  up: number;
  away: number;
  turn: readonly [number, number, number]; // about right, up and towards the eye, of a tool that turns
  open: number; // of a gripper
  depth: number; // as away, where what is away turns the tool
  buttons: number; // bits
}

const kDead = 0.12;
const kSpaceMouse = /3dconnexion|space\s?(mouse|navigator|pilot|explorer)/i;

/** Nothing inside the dead zone, then from 0 on, finer near the middle. */
export function bend(value: number): number {
  const over = Math.abs(value) - kDead;
  return over <= 0 ? 0 : Math.sign(value) * (over / (1 - kDead)) ** 1.6;
}

/** Left stick: in the plane of the view; right stick: depth, or what turns the tool: then shoulder buttons are for depth, triggers for the gripper. */
export function readPad(pad: Pick<Gamepad, "id" | "axes" | "buttons">): PadReading {
  const axis = (i: number) => bend(pad.axes[i] ?? 0);
  const buttons = pad.buttons.reduce((bits, b, i) => (b.pressed && i < 31 ? bits | (1 << i) : bits), 0);
  if (kSpaceMouse.test(pad.id)) {
    const away = -axis(1);
    return { right: axis(0), up: -axis(2), away, depth: away, turn: [axis(3), -axis(5), axis(4)], open: 0, buttons };
  }
  const value = (i: number) => pad.buttons[i]?.value ?? 0;
  return {
    right: axis(0), up: -axis(1), away: -axis(3), depth: value(5) - value(4), turn: [axis(3), axis(2), 0], open: value(7) - value(6), buttons,
  };
}

export class Gamepads {
  /** All of them together; undefined where there is none. */
  read(): PadReading | undefined {
    const pads = (navigator.getGamepads?.() ?? []).filter((pad) => pad?.connected);
    if (pads.length === 0) return undefined;
    return pads.map((pad) => readPad(pad!)).reduce((sum, one) => ({
      right: sum.right + one.right, up: sum.up + one.up, away: sum.away + one.away, depth: sum.depth + one.depth,
      turn: [sum.turn[0] + one.turn[0], sum.turn[1] + one.turn[1], sum.turn[2] + one.turn[2]],
      open: sum.open + one.open, buttons: sum.buttons | one.buttons,
    }));
  }
}
