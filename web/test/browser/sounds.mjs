// What surfaces sound like, rendered by the browser without a loudspeaker. Part of run.mjs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { serve } from "../fake_server.mjs";
import { kPresets, settings } from "../fake/program.mjs";
import { openPage, until } from "./browser.mjs";
import { browser, kSmall, ready } from "./with_page.mjs";

const kRate = 48_000; // Hz
const kWindow = 1 << 15; // samples, 0.7 s

/** A page that has the parts of the sound as window.parts. */
async function openParts() {
  const { outputFiles } = await build({
    stdin: {
      contents: 'export * from "./src/sound/voice"; export * from "./src/sound/surface"; export * from "./src/model/fft";',
      resolveDir: fileURLToPath(new URL("../..", import.meta.url)),
    },
    bundle: true, write: false, format: "iife", globalName: "parts", target: "es2022",
  });
  const page = await openPage(browser, "about:blank", kSmall);
  await page.evaluate(`${outputFiles[0].text}; window.parts = parts;`);
  return page;
}

const presetValues = (name) => ({ ...Object.fromEntries(settings().map(({ key, value }) => [key, value])), ...kPresets.default, ...kPresets[name] });

/** What can be set where a device bears no more than `stiffest` N/m. */
const borne = (stiffest) => settings().map((one) => (one.key === "stiffness" ? { ...one, most: stiffest } : one));

/** Hears a stroke at `speed` (m/s) with `force` (N), or with `drop` (m/s) a hand that comes down; powers of its last part by frequency. */
async function hearing(page, name, { speed = 0.1, force = 1, drop = 0, stiffest = 2000 } = {}) {
  const values = presetValues(name);
  values.stiffness = Math.min(stiffest, values.stiffness);
  const asked = { values, settings: borne(stiffest), speed, force, drop, rate: kRate, window: kWindow };
  return page.evaluate(async ({ values, settings, speed, force, drop, rate, window: count }) => {
    const { Voice, surfaceOf, fft } = window.parts;
    const surface = surfaceOf(settings, new Map(Object.entries(values)));
    const context = new window.OfflineAudioContext(1, count + rate / 2, rate);
    const voice = new Voice(context);
    const tell = (i) => {
      const time = i / 60;
      const z = -drop * time;
      voice.play({ time, flags: drop > 0 && i < 31 ? 0 : 1, hip: [speed * time, 0, z], proxy: [speed * time, 0, z], force: [0, 0, force] }, surface);
    };
    for (let i = 0; i < (60 * (count + rate / 2)) / rate; i += 1) {
      if (drop > 0 && i > 31) break; // one touch
      if (i === 0) tell(0);
      else void context.suspend(i / 60).then(() => {
        tell(i);
        return context.resume();
      });
    }
    const samples = (await context.startRendering()).getChannelData(0).slice(rate / 2);
    const real = Float64Array.from(samples, (sample, i) => sample * (drop > 0 ? 1 : 1 - Math.cos((2 * Math.PI * i) / count)));
    const imaginary = new Float64Array(count);
    fft(real, imaginary);
    return {
      level: Math.sqrt(samples.reduce((sum, sample) => sum + sample * sample, 0) / count),
      powers: Array.from(real.subarray(0, count / 2), (x, k) => x * x + imaginary[k] ** 2),
    };
  }, asked);
}

const sum = (numbers) => numbers.reduce((all, one) => all + one, 0);
const between = ({ powers }, low, high) => sum(powers.slice(Math.round((low * kWindow) / kRate), Math.round((high * kWindow) / kRate)));
/** Frequency at the middle of the power, Hz. */
const middle = ({ powers }) => (sum(powers.map((power, k) => k * power)) / sum(powers)) * (kRate / kWindow);
const strongest = ({ powers }) => (powers.indexOf(Math.max(...powers)) * kRate) / kWindow;

test("at a usual stroke ice whispers, fur hisses softly, wood rattles and rubber is loudest", async (t) => {
  const page = await openParts();
  for (const stiffest of [2000, 800]) await differ(t, page, stiffest);
  await page.context().close();
});

async function differ(t, page, stiffest) {
  const heard = {};
  for (const name of ["fur", "wood", "ice", "rubber"]) heard[name] = await hearing(page, name, { stiffest });
  const told = Object.entries(heard).map(([name, one]) => `${name} ${one.level.toFixed(4)} ${middle(one).toFixed(0)} Hz`).join(", ");
  const { fur, wood, ice, rubber } = heard;
  t.diagnostic(told);
  assert.ok(ice.level > 0.004, `heard: ${told}`);
  assert.ok(ice.level < 0.7 * fur.level && fur.level < wood.level && wood.level < rubber.level, told);
  assert.ok(middle(fur) > 1.3 * middle(ice) && middle(ice) > 1.3 * middle(rubber), told);
  const tone = strongest(rubber);
  assert.ok(between(rubber, tone - 15, tone + 15) > 0.5 * sum(rubber.powers), `rubber sings: ${told}`);
  assert.ok(between(fur, strongest(fur) - 15, strongest(fur) + 15) < 0.1 * sum(fur.powers), `fur does not: ${told}`);
}

test("the grain of wood passes with the speed over its wavelength", async () => {
  const page = await openParts();
  for (const speed of [0.1, 0.2]) {
    const wood = await hearing(page, "wood", { speed });
    const tone = speed / 2e-3; // Hz
    const overtones = Array.from({ length: 10 }, (_, i) => (i + 2) * tone);
    const on = sum(overtones.map((f) => between(wood, f - 5, f + 5)));
    const beside = sum(overtones.map((f) => between(wood, f + tone / 2 - 5, f + tone / 2 + 5)));
    assert.ok(on > 5 * beside, `at ${speed} m/s: ${on / beside}`);
  }
  await page.context().close();
});

test("every slip is heard from 5 to 20 cm/s, and none at rest", async () => {
  const page = await openParts();
  for (const name of ["default", "fur", "wood", "ice", "rubber"]) {
    for (const speed of [0.05, 0.2]) {
      const { level } = await hearing(page, name, { speed });
      assert.ok(level > 0.003, `${name} at ${speed} m/s: ${level}`); // -50 dB
    }
    assert.ok((await hearing(page, name, { speed: 0 })).level < 1e-4, `${name} rests`);
  }
  await page.context().close();
});

test("a knock is the higher the stiffer: fur, rubber, wood, ice", async () => {
  const page = await openParts();
  const pitches = [];
  for (const name of ["fur", "rubber", "wood", "ice"]) pitches.push(strongest(await hearing(page, name, { speed: 0, drop: 0.1 })));
  pitches.slice(1).forEach((pitch, i) => assert.ok(pitch > pitches[i], pitches.join()));
  assert.ok(Math.abs(pitches[3] / pitches[0] - Math.sqrt(1200 / 150)) < 0.3, pitches.join());
  await page.context().close();
});

test("when states stop, the slip is soon over", async () => {
  const page = await openParts();
  const level = await page.evaluate(async () => {
    const { Voice } = window.parts;
    const context = new window.OfflineAudioContext(1, 48_000, 48_000);
    const voice = new Voice(context);
    const surface = { stiff: 0.25, friction: 1, amplitude: 0, wavelength: 0 };
    for (let i = 0; i < 2; i += 1) voice.play({ time: i / 60, flags: 1, hip: [0, 0, 0], proxy: [i / 600, 0, 0], force: [0, 0, 1] }, surface);
    const samples = (await context.startRendering()).getChannelData(0);
    return [samples.slice(0, 10_000), samples.slice(30_000)].map((part) => Math.max(...part));
  });
  assert.ok(level[0] > 0.01 && level[1] < 0.001, level.join());
  await page.context().close();
});

test("the page's sound is that of the preset: rubber louder than ice", async () => {
  const server = await serve({ points: 2000 });
  const page = await openPage(browser, server.address, kSmall, () => {
    const Plain = window.AudioContext;
    window.AudioContext = class extends Plain {
      constructor() {
        super();
        window.ear = new window.AnalyserNode(this, { fftSize: 8192 });
        window.ear.connect(super.destination);
      }

      get destination() {
        return window.ear ?? super.destination;
      }
    };
  }, true);
  await ready(page);
  server.program.servo.exploring = () => {
    const x = 0.08 * Math.sin(1.5 * server.program.servo.time);
    return [x, 0.1, -0.004]; // in the table, to and fro
  };
  await page.click("#sound");
  const level = () => page.evaluate(async () => {
    const samples = new Float32Array(8192);
    let sum = 0;
    for (let i = 0; i < 20; i += 1) {
      await new Promise((done) => setTimeout(done, 100));
      window.ear.getFloatTimeDomainData(samples);
      sum += samples.reduce((all, sample) => all + sample * sample, 0);
    }
    return Math.sqrt(sum / 20 / samples.length);
  });
  const choose = async (name) => {
    await page.locator("#presets").getByRole("button", { name }).click();
    await page.waitForTimeout(500);
    return level();
  };
  const [ice, rubber] = [await choose("ice"), await choose("rubber")];
  assert.ok(ice > 0.001 && rubber > 3 * ice, `ice ${ice}, rubber ${rubber}`);
  await until("no more, once it is off", async () => {
    await page.click("#sound");
    return (await page.getAttribute("#sound", "aria-pressed")) === "false";
  });
  assert.deepEqual(page.troubles, []);
  await page.context().close();
  await server.close();
});
