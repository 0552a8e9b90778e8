// The force in the hand that holds the tool: the motors of a controller, and a phone that shakes.

import { Flag, type StateMessage } from "../protocol/decode";

const kInterval = 80; // ms between two commands to a motor
const kOverlap = 40; // ms that it runs on, so that it does not stop in between
const kFullForce = 3; // N that a motor gives with all it has
const kFullTexture = 0.5; // N, root of the mean square of what changes between two states

/** What stays of a force is for a controller's slow motor, what changes (texture, slip) for its fast one; 0 to 1. */
export function strengths(state: Pick<StateMessage, "flags" | "force" | "samples">): { slow: number; fast: number } {
  if ((state.flags & Flag.touching) === 0) return { slow: 0, fast: 0 };
  const count = Math.max(1, Math.floor(state.samples.length / 3));
  let change = 0;
  for (const axis of [0, 1, 2]) {
    const own = state.samples.filter((_, i) => i % 3 === axis);
    const mean = own.reduce((sum, value) => sum + value, 0) / count;
    change += own.reduce((sum, value) => sum + (value - mean) ** 2, 0) / count;
  }
  return {
    slow: Math.min(1, Math.hypot(...state.force) / kFullForce),
    fast: Math.min(1, Math.sqrt(change) / kFullTexture),
  };
}

export class Rumble {
  on = true;
  private sent = -Infinity; // ms

  /** Of the tool that this page holds; `now` in ms. */
  feel(state: StateMessage, now: number): void {
    if (!this.on || now - this.sent < kInterval) return;
    const { slow, fast } = strengths(state);
    if (slow === 0 && fast === 0) return; // what runs ends by itself
    this.sent = now;
    for (const pad of navigator.getGamepads?.() ?? []) {
      const effect = { duration: kInterval + kOverlap, strongMagnitude: slow, weakMagnitude: fast };
      void pad?.vibrationActuator?.playEffect("dual-rumble", effect).catch(() => undefined); // it has none after all
    }
    // A phone's motor has a single strength: the larger the force, the longer it runs of each interval.
    if (navigator.userActivation?.hasBeenActive) navigator.vibrate?.(Math.round(kInterval * Math.max(slow, fast)));
  }
}
