import assert from "node:assert/strict";
import { test } from "node:test";
import { fft } from "../src/model/fft";
import { Ring } from "../src/model/ring";
import { DeviceHistory, SourceHistory } from "../src/model/session";
import { kWindow, Spectrum } from "../src/model/spectrum";
import { decode, Kind, type CloudMessage, type StateMessage } from "../src/protocol/decode";

test("the fast transform agrees with the sum it stands for", () => {
  const n = 16;
  const signal = Array.from({ length: n }, (_, i) => Math.sin(1.3 * i) + 0.2 * i);
  const other = Array.from({ length: n }, (_, i) => Math.cos(0.7 * i * i));
  const real = Float64Array.from(signal);
  const imaginary = Float64Array.from(other);
  fft(real, imaginary);
  for (let k = 0; k < n; k += 1) {
    let [re, im] = [0, 0];
    for (let i = 0; i < n; i += 1) {
      const angle = (-2 * Math.PI * k * i) / n;
      re += signal[i]! * Math.cos(angle) - other[i]! * Math.sin(angle);
      im += signal[i]! * Math.sin(angle) + other[i]! * Math.cos(angle);
    }
    assert.ok(Math.abs(real[k]! - re) < 1e-9 && Math.abs(imaginary[k]! - im) < 1e-9, `bin ${k}`);
  }
});

test("a length that is no power of two is refused", () => {
  assert.throws(() => fft(new Float64Array(12), new Float64Array(12)), RangeError);
});

test("a sine shows its amplitude at its frequency, whatever constant it rides on", () => {
  const bin = 64;
  const sine = Float64Array.from({ length: kWindow }, (_, i) => 5 + 0.3 * Math.sin((2 * Math.PI * bin * i) / kWindow));
  const amplitudes = new Spectrum().update([sine]);
  assert.ok(Math.abs(amplitudes[bin]! - 0.3) < 1e-9);
  assert.ok(amplitudes[0]! < 1e-9 && amplitudes[bin + 3]! < 1e-9);
});

test("components add as squares", () => {
  const tone = (size: number) => Float64Array.from({ length: kWindow }, (_, i) => size * Math.cos((2 * Math.PI * 10 * i) / kWindow));
  assert.ok(Math.abs(new Spectrum().update([tone(3), tone(4)])[10]! - 5) < 1e-9);
});

test("a ring keeps the newest rows in order", () => {
  const ring = new Ring(4, 2);
  for (let i = 0; i < 7; i += 1) ring.push(i, 10 * i);
  assert.equal(ring.length, 4);
  assert.deepEqual([...ring.copy(0)], [3, 4, 5, 6]);
  assert.deepEqual([...ring.copy(1, 2)], [50, 60]);
  assert.equal(ring.at(1, 0), 30);
  assert.ok(Number.isNaN(ring.at(0, 4)));
  assert.equal(ring.from(4.5), 2);
  assert.equal(ring.from(99), 4);
  ring.clear();
  assert.equal(ring.copy(0).length, 0);
});

test("the share of a cloud that is not trusted is that of its bytes below 128; a camera's is not told", () => {
  const buffer = new ArrayBuffer(40 + 4 * 7);
  const view = new DataView(buffer);
  view.setUint8(0, 2);
  view.setUint16(2, 4, true);
  view.setUint32(4, 4, true);
  [127, 128, 255, 0].forEach((trust, i) => view.setUint8(40 + 4 * 6 + i, trust));
  const [still, live] = [new SourceHistory("still", false), new SourceHistory("live", true)];
  for (const source of [still, live]) source.takeCloud(decode(buffer) as CloudMessage);
  assert.equal(still.untrusted, 0.5);
  assert.equal(still.shown, 4);
  assert.equal(live.untrusted, 0);
});

function stateAt(time: number, samples: number[]): StateMessage {
  return {
    kind: 1, device: 0, flags: 0, time, hip: [0, 0, 0], proxy: [0, 0, 0], normal: [0, 0, 0], force: [0, 0, 0],
    radius: 0, rate: 1000, step: [0, 0], lateness: [0, 0], interval: 0.001, samples: Float32Array.from(samples),
    orientation: undefined, tool: undefined,
  };
}

test("samples of a state end at its time", () => {
  const history = new DeviceHistory();
  history.take(stateAt(2, [3, 4, 0, 0, 0, 2]), 0);
  assert.deepEqual([...history.force.copy(0)].map((time) => Number(time.toFixed(6))), [1.999, 2]);
  assert.deepEqual([...history.force.copy(4)], [5, 2]);
});

test("a program that begins again begins a new history", () => {
  const history = new DeviceHistory();
  history.take(stateAt(100, [1, 0, 0]), 0);
  history.take(stateAt(1, [2, 0, 0]), 1);
  assert.deepEqual([...history.force.copy(0)], [1]);
});

test("the past of a recording takes the place of what was shown, and what follows is put behind it", () => {
  const history = new DeviceHistory();
  history.force.push(80, 1, 1, 1, 2);
  history.takePast({ kind: Kind.past, device: 0, time: 12, samples: Float32Array.of(-0.5, 3, 0, 4, 0, 0, 1, 0) });
  assert.deepEqual([...history.force.copy(0)], [11.5, 12]);
  assert.deepEqual([...history.force.copy(4)], [5, 1]);
  history.takePast({ kind: Kind.past, device: 0, time: 0, samples: new Float32Array() });
  assert.equal(history.force.length, 0);
});
