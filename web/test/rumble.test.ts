import assert from "node:assert/strict";
import { test } from "node:test";
import { Flag, type StateMessage } from "../src/protocol/decode";
import { Rumble, strengths } from "../src/sound/rumble";

function felt(force: [number, number, number], samples: number[] = [...force, ...force], flags: number = Flag.touching): StateMessage {
  return { flags, force, samples: Float32Array.from(samples) } as unknown as StateMessage;
}

test("what stays of a force is for the slow motor, what changes for the fast one", () => {
  assert.deepEqual(strengths(felt([0, 0, 3])), { slow: 1, fast: 0 });
  assert.deepEqual(strengths(felt([0, 0, 30])), { slow: 1, fast: 0 });
  const rough = strengths(felt([0, 0, 1.5], [0, 0, 1.25, 0, 0, 1.75]));
  assert.deepEqual(rough, { slow: 0.5, fast: 0.5 });
  assert.deepEqual(strengths(felt([0, 0, 3], [0, 0, 0, 0, 0, 3], 0)), { slow: 0, fast: 0 }, "nothing in the air");
});

test("motors run while something is felt, hear of it now and then, and not at all when they are not to", () => {
  const effects: GamepadEffectParameters[] = [];
  const times: number[] = [];
  const actuator = { playEffect: (_: string, effect: GamepadEffectParameters) => (effects.push(effect), Promise.resolve("complete")) };
  const fake = {
    getGamepads: () => [null, {}, { vibrationActuator: actuator }],
    vibrate: (time: number) => times.push(time),
    userActivation: { hasBeenActive: true },
  };
  Object.defineProperty(globalThis, "navigator", { value: fake, configurable: true });
  const rumble = new Rumble();
  for (let now = 0; now < 800; now += 16) rumble.feel(felt([0, 1.5, 0]), now);
  assert.equal(effects.length, 10);
  assert.ok(effects.every(({ strongMagnitude }) => strongMagnitude === 0.5));
  assert.deepEqual(times, Array.from({ length: 10 }, () => 40), "half of the time");
  for (let now = 800; now < 1600; now += 16) rumble.feel(felt([0, 0, 0], [0, 0, 0], 0), now);
  rumble.on = false;
  rumble.feel(felt([0, 1.5, 0]), 1600);
  assert.equal(effects.length, 10);
});
