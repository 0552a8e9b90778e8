import assert from "node:assert/strict";
import { test } from "node:test";
import { PerspectiveCamera, Vector3 } from "three";
import { bend, readPad } from "../src/input/gamepad";
import { readRotation, readTranslation } from "../src/input/space_mouse";
import { decimals, distrust, inStep, millimetres, Scale, seconds, short, threeDigits, whole } from "../src/panel/numbers";
import { samplesOf } from "../src/view/backdrop";
import { boundsOf, type Sample } from "../src/view/bounds";
import { firstDirection } from "../src/view/first_view";
import { rampTexture } from "../src/view/colours";
import { lengthInWords, scaleBar } from "../src/view/scale_bar";
import { savedSharpness } from "../src/view/stage";
import { shareInPicture } from "../src/view/tool";

test("a saved picture is twice as large as the screen up to 4096 pixels a side, and never smaller than the screen", () => {
  assert.equal(savedSharpness(1280, 1, 1), 2);
  assert.equal(savedSharpness(1280, 2, 2), 3.2);
  assert.equal(savedSharpness(3000, 2, 2), 2, "6000 pixels, as the screen has");
  assert.equal(savedSharpness(5120, 1, 1), 1);
  assert.equal(savedSharpness(3000, 1, 2), 2, "without a graphics card");
  assert.equal(savedSharpness(400, 2, 3), 4, "a phone");
});

test("samples of a picture take 128 MiB at most, of 8 bytes each", () => {
  assert.equal(samplesOf(1920 * 1080, 4), 4);
  assert.equal(samplesOf(3840 * 2160, 4), 2);
  assert.equal(samplesOf(4096 * 2560, 4), 0, "those of one sample are no samples");
  assert.equal(samplesOf(100, 0), 0);
});

test("a scale bar is a round length between 60 and 150 pixels", () => {
  for (let power = -6; power < 2; power += 0.07) {
    const metresPerPixel = 10 ** power / 100;
    const { pixels, label } = scaleBar(metresPerPixel, 1000);
    assert.ok(pixels >= 59.9 && pixels <= 150.1, `${pixels} pixels for ${label}`);
    assert.match(label, /^[125]0*(\.0+)? (µm|mm|m)$|^0\.[125] /);
  }
});

test("an arrow that would leave the picture ends before its edge, whichever way it points", () => {
  const camera = new PerspectiveCamera(40, 1.5, 0.01, 10);
  camera.position.set(0, 0, 1);
  camera.updateMatrixWorld();
  const from = new Vector3(0.1, 0.2, 0);
  assert.equal(shareInPicture(camera, from, new Vector3(0.15, 0.25, 0.1)), 1);
  for (let angle = 0; angle < 6.28; angle += 0.1) {
    for (const deep of [-0.3, 0, 0.3]) {
      const to = from.clone().add(new Vector3(Math.cos(angle), Math.sin(angle), deep).setLength(0.8));
      const share = shareInPicture(camera, from, to);
      const tip = from.clone().lerp(to, share).project(camera);
      const farthest = Math.max(Math.abs(tip.x), Math.abs(tip.y));
      assert.ok(farthest < 0.95 && share > 0, `${angle}, ${deep}: ends at ${farthest}`);
      assert.ok(share === 1 || farthest > 0.93, `${angle}, ${deep}: is too short, at ${farthest}`);
    }
  }
});

test("lengths take the unit that suits them", () => {
  assert.equal(lengthInWords(0.05), "50 mm");
  assert.equal(lengthInWords(2), "2 m");
  assert.equal(lengthInWords(0.0002), "200 µm");
});

test("numbers read well", () => {
  assert.equal(decimals(0.05), 2);
  assert.equal(decimals(10), 0);
  assert.equal(inStep(0.30000000000000004, 0.1), "0.3");
  assert.equal(inStep(2.504, 10), "2.5");
  assert.equal(inStep(0.000123456, 0.002), "0.000123");
  assert.equal(inStep(500.12, 20), "500");
  assert.equal(whole(1234567), "1\u202f234\u202f567");
  assert.equal(threeDigits(-8.4e-11), "0");
  assert.equal(threeDigits(-1.2345), "−1.23");
  assert.equal(short(30_000), "30k");
  assert.equal(seconds(0.0412), "41 ms");
  assert.equal(seconds(NaN), "–");
  assert.equal(millimetres(0.00068), "0.68 mm");
});

test("what is not trusted of a cloud is told from a hundredth on", () => {
  assert.equal(distrust(0.123), "12 % of this cloud has low trust and is rendered as a metaball");
  assert.equal(distrust(0.0099), "");
});

test("trust changes its hue where a byte stands for a half", () => {
  const pixels = rampTexture().image.data as Uint8Array;
  const warm = (byte: number) => pixels[4 * (2 * 256 + byte)]! > pixels[4 * (2 * 256 + byte) + 2]!;
  for (let byte = 0; byte < 256; byte += 1) assert.equal(warm(byte), byte / 255 < 0.5, String(byte));
});

test("a slider's scale is even for small ranges and by ratio for wide ones", () => {
  assert.equal(new Scale(0, 10).position(2.5), 0.25);
  const wide = new Scale(10, 1000);
  assert.ok(Math.abs(wide.position(100) - 0.5) < 1e-12);
  for (const value of [10, 57, 1000]) assert.ok(Math.abs(wide.value(wide.position(value)) - value) < 1e-9);
});

test("sticks rest inside their dead zone and reach one at their end", () => {
  assert.equal(bend(0.1), 0);
  assert.equal(bend(1), 1);
  assert.equal(bend(-1), -1);
});

test("controllers and 3D mice mean the same directions", () => {
  const buttons = [{ pressed: true }, { pressed: false }, { pressed: true }] as GamepadButton[];
  const pad = readPad({ id: "Standard", axes: [1, -1, 0, -1], buttons });
  assert.deepEqual(pad, { right: 1, up: 1, away: 1, depth: 0, turn: [-1, 0, 0], open: 0, buttons: 5 });
  const mouse = readPad({ id: "3Dconnexion SpaceMouse", axes: [1, -1, -1, 1, -1, 1], buttons: [] });
  assert.deepEqual(mouse, { right: 1, up: 1, away: 1, depth: 1, turn: [1, -1, -1], open: 0, buttons: 0 });
  const report = new DataView(new ArrayBuffer(6));
  [350, -350, -350].forEach((value, i) => report.setInt16(2 * i, value, true));
  assert.deepEqual(readTranslation(report), { right: 1, up: 1, away: 1, depth: 1 });
  assert.deepEqual(readRotation(report, 0), [1, 1, -1]);
});

test("bounds leave outliers out", () => {
  const samples = sheet((u, v) => new Vector3(u, v, 0), new Vector3(0, 0, 1));
  samples.push({ position: new Vector3(1000, 0, 0), normal: undefined });
  const bounds = boundsOf(samples);
  assert.ok(bounds !== undefined && bounds.radius < 1);
  assert.ok(bounds.samples.every(({ position }) => position.x < 2));
  assert.equal(boundsOf([]), undefined);
});

/** 400 points over 0..1 x 0..1. */
function sheet(at: (u: number, v: number) => Vector3, normal: Vector3): Sample[] {
  return Array.from({ length: 400 }, (_, i) => ({ position: at((i % 20) / 19, Math.floor(i / 20) / 19), normal }));
}

test("a corner of a room is seen first from where its walls face, whatever the axes", () => {
  const up = new Vector3(0, 0, 1);
  for (const turn of [0, 1, 2.5, 4]) {
    const turned = (x: number, y: number, z: number) => new Vector3(x, y, z).applyAxisAngle(up, turn);
    const bounds = boundsOf([
      ...sheet((u, v) => turned(u, v, 0), up),
      ...sheet((u, v) => turned(u, 0, v), turned(0, 1, 0)),
      ...sheet((u, v) => turned(0, u, v), turned(1, 0, 0)),
    ])!;
    const direction = firstDirection(up, [], bounds);
    assert.ok(direction.dot(turned(0, 1, 0)) > 0 && direction.dot(turned(1, 0, 0)) > 0, `turned by ${turn}`);
  }
});

test("what has no normals is seen from its cameras' side", () => {
  const up = new Vector3(0, 0, 1);
  const flat = sheet((u, v) => new Vector3(u, v, 0), up).map(({ position }) => ({ position, normal: undefined }));
  const direction = firstDirection(up, [new Vector3(5, 0.5, 1)], boundsOf(flat)!);
  assert.ok(direction.x > 0.5);
});
