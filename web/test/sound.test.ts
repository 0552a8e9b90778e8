import assert from "node:assert/strict";
import { test } from "node:test";
import type { Setting } from "../src/protocol/messages";
import { pitchOf, slipOf, surfaceOf, type Surface } from "../src/sound/surface";

const kSmooth: Surface = { stiff: 0.25, friction: 0.2, amplitude: 0, wavelength: 4e-3 };

test("a surface four times as stiff knocks an octave higher", () => {
  const ratio = pitchOf({ ...kSmooth, stiff: 0.8 }) / pitchOf({ ...kSmooth, stiff: 0.2 });
  assert.ok(Math.abs(ratio - 2) < 1e-9, String(ratio));
  assert.ok(pitchOf({ ...kSmooth, stiff: 0 }) > 20, "heard, however soft");
});

test("what rests is silent, and a slip is louder with speed, force and friction", () => {
  const loud = (surface: Surface, speed: number, force: number) => slipOf(surface, speed, force).noise.gain;
  assert.equal(loud(kSmooth, 0, 1), 0);
  assert.equal(loud(kSmooth, 0.1, 0), 0);
  const usual = loud(kSmooth, 0.05, 1);
  assert.ok(usual > 0.02, `${usual} at 5 cm/s`);
  assert.ok(loud(kSmooth, 0.1, 1) > usual && loud(kSmooth, 0.05, 2) > usual);
  assert.ok(loud({ ...kSmooth, friction: 0.6 }, 0.05, 1) > 1.2 * usual);
  assert.ok(loud({ ...kSmooth, friction: 0 }, 0.05, 1) > 0, "without friction it whispers");
});

test("grains pass with the speed over the wavelength, where that is known", () => {
  const rough = { ...kSmooth, amplitude: 1e-4 };
  assert.equal(slipOf(rough, 0.1, 1).grain.frequency, 25);
  assert.ok(slipOf(rough, 0.1, 1).grain.gain > 0);
  assert.equal(slipOf(kSmooth, 0.1, 1).grain.gain, 0, "smooth");
  assert.equal(slipOf({ ...rough, wavelength: 0 }, 0.1, 1).grain.gain, 0, "not known");
  assert.equal(slipOf(rough, 0.01, 1).grain.gain, 0, "too slow for a tone");
});

test("what holds a hand back squeaks, and nothing else", () => {
  const squeak = (friction: number) => slipOf({ ...kSmooth, friction }, 0.1, 1).squeak.gain;
  assert.equal(squeak(0.5), 0);
  assert.ok(squeak(1) > 0.1);
});

test("a surface is read from the settings, in their units", () => {
  const setting = (key: string, unit: string, most: number): Setting => ({ key, label: key, unit, kind: "number", least: 0, most, value: 0 });
  const settings = [setting("stiffness", "N/m", 2000), setting("friction", "", 1.5), setting("texture", "mm", 1), setting("wavelength", "mm", 10)];
  const values = new Map(Object.entries({ stiffness: 500, friction: 0.4, texture: 0.1, wavelength: 2 }));
  assert.deepEqual(surfaceOf(settings, values), { stiff: 0.25, friction: 0.4, amplitude: 1e-4, wavelength: 2e-3 });
  const large = [settings[0]!, setting("texture", "m", 1), setting("wavelength", "m", 10)];
  assert.equal(surfaceOf(large, values).wavelength, 2);
  assert.equal(surfaceOf([], new Map()).wavelength, 0, "a recording says nothing");
});
