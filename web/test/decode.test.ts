import assert from "node:assert/strict";
import { test } from "node:test";
import { decode, DecodeError, Flag, Kind, radiusOf, type CloudMessage, type PastMessage, type StateMessage, type SurfaceMessage, type ToolMessage } from "../src/protocol/decode";

/** Bytes written one by one, as docs/viewer_protocol.md lists them. */
class Writer {
  private readonly bytes: number[] = [];
  private readonly view = new DataView(new ArrayBuffer(8));

  private take(count: number): this {
    for (let i = 0; i < count; i += 1) this.bytes.push(this.view.getUint8(i));
    return this;
  }
  u8(...values: number[]): this {
    values.forEach((value) => this.bytes.push(value & 0xff));
    return this;
  }
  u16(...values: number[]): this {
    values.forEach((value) => (this.view.setUint16(0, value, true), this.take(2)));
    return this;
  }
  u32(value: number): this {
    this.view.setUint32(0, value, true);
    return this.take(4);
  }
  f32(...values: number[]): this {
    values.forEach((value) => (this.view.setFloat32(0, value, true), this.take(4)));
    return this;
  }
  f64(value: number): this {
    this.view.setFloat64(0, value, true);
    return this.take(8);
  }
  get buffer(): ArrayBuffer {
    return Uint8Array.from(this.bytes).buffer;
  }
}

function state(samples: number): ArrayBuffer {
  const writer = new Writer().u8(1, 2).u16(samples).u32(Flag.touching | Flag.clamped).f64(12.5);
  writer.f32(1, 2, 3).f32(4, 5, 6).f32(0, 0, 1).f32(7, 8, 9).f32(0.25).f32(1000);
  writer.f32(0.5, 0.75).f32(0.125, 0.0625).f32(0.5);
  for (let i = 0; i < 3 * samples; i += 1) writer.f32(i);
  return writer.buffer;
}

function cloud(flags: number): ArrayBuffer {
  const writer = new Writer().u8(2, 1).u16(flags).u32(3).f64(2.5).f32(-1, -2, -3).f32(2, 4, 6);
  writer.u16(0, 0, 0, 65535, 65535, 65535, 1, 2, 3);
  if ((flags & 1) !== 0) writer.u8(10, 20, 30, 40, 50, 60, 70, 80, 255);
  if ((flags & 2) !== 0) writer.u8(127, 0, 0, -127, -1, 1);
  if ((flags & 4) !== 0) writer.u8(0, 127, 255);
  if ((flags & 8) !== 0) writer.u8(0, 144, 168);
  return writer.buffer;
}

function surface(last: number): ArrayBuffer {
  const writer = new Writer().u8(3, 1).u16(3).u32(1).f32(1, 2, 3).f32(0.5);
  return writer.u16(0, 0, 0, 32767, 0, 0, 0, 0x8001, 0).u16(0, 1, last).buffer;
}

test("a state is read as it was written", () => {
  const message = decode(state(2)) as StateMessage;
  assert.equal(message.kind, Kind.state);
  assert.equal(message.device, 2);
  assert.equal(message.flags, 9);
  assert.equal(message.time, 12.5);
  assert.deepEqual(message.hip, [1, 2, 3]);
  assert.deepEqual(message.proxy, [4, 5, 6]);
  assert.deepEqual(message.normal, [0, 0, 1]);
  assert.deepEqual(message.force, [7, 8, 9]);
  assert.equal(message.radius, 0.25);
  assert.equal(message.rate, 1000);
  assert.deepEqual(message.step, [0.5, 0.75]);
  assert.deepEqual(message.lateness, [0.125, 0.0625]);
  assert.equal(message.interval, 0.5);
  assert.deepEqual([...message.samples], [0, 1, 2, 3, 4, 5]);
});

function oriented(): ArrayBuffer {
  const bytes = new Uint8Array([...new Uint8Array(state(1)), ...new Uint8Array(new Writer().f32(0, 0.6, 0, 0.8).buffer)]);
  new DataView(bytes.buffer).setUint32(4, Flag.oriented | Flag.clutched, true);
  return bytes.buffer;
}

test("a state tells how the tool is held, where the device does", () => {
  assert.equal((decode(state(1)) as StateMessage).orientation, undefined);
  const message = decode(oriented()) as StateMessage;
  assert.equal(message.samples.length, 3);
  assert.deepEqual(message.orientation, [0, Math.fround(0.6), 0, Math.fround(0.8)]);
});

test("a state may have no samples", () => {
  assert.equal((decode(state(0)) as StateMessage).samples.length, 0);
});

test("a cloud is read with and without colours, normals, trust and radii", () => {
  const all = decode(cloud(15)) as CloudMessage;
  assert.equal(all.source, 1);
  assert.equal(all.count, 3);
  assert.equal(all.stamp, 2.5);
  assert.deepEqual(all.lower, [-1, -2, -3]);
  assert.deepEqual(all.extent, [2, 4, 6]);
  assert.deepEqual([...all.positions], [0, 0, 0, 65535, 65535, 65535, 1, 2, 3]);
  assert.deepEqual([...all.colours!], [10, 20, 30, 40, 50, 60, 70, 80, 255]);
  assert.deepEqual([...all.normals!], [127, 0, 0, -127, -1, 1]);
  assert.deepEqual([...all.trust!], [0, 127, 255]);
  assert.deepEqual([...all.radii!], [0, 144, 168]);
  assert.deepEqual([...(decode(cloud(8)) as CloudMessage).radii!], [0, 144, 168]);
  assert.deepEqual([...(decode(cloud(4)) as CloudMessage).trust!], [0, 127, 255]);
  const normals = decode(cloud(2)) as CloudMessage;
  assert.equal(normals.colours, undefined);
  assert.deepEqual([...normals.normals!], [127, 0, 0, -127, -1, 1]);
  const bare = decode(cloud(0)) as CloudMessage;
  assert.equal(bare.colours, undefined);
  assert.equal(bare.normals, undefined);
  assert.equal(bare.trust, undefined);
  assert.equal(bare.radii, undefined);
});

test("a radius is a byte of eighths of octaves", () => {
  assert.equal(radiusOf(160), 1);
  assert.equal(radiusOf(144), 0.25);
  assert.equal(radiusOf(0), 2 ** -20);
});

test("a surface is read, and must not point beyond its vertices", () => {
  const message = decode(surface(2)) as SurfaceMessage;
  assert.equal(message.device, 1);
  assert.deepEqual(message.centre, [1, 2, 3]);
  assert.equal(message.extent, 0.5);
  assert.deepEqual([...message.vertices], [0, 0, 0, 32767, 0, 0, 0, -32767, 0]);
  assert.deepEqual([...message.triangles], [0, 1, 2]);
  assert.throws(() => decode(surface(3)), DecodeError);
});

function past(): ArrayBuffer {
  return new Writer().u8(4, 1).u16(0).u32(2).f64(12.5).f32(-0.5, 1, 2, 3).f32(0, 4, 5, 6).buffer;
}

test("the past of a recording is read as it was written", () => {
  const message = decode(past()) as PastMessage;
  assert.equal(message.device, 1);
  assert.equal(message.time, 12.5);
  assert.deepEqual([...message.samples], [-0.5, 1, 2, 3, 0, 4, 5, 6]);
});

test("a surface may be empty: nothing is near", () => {
  const message = decode(new Writer().u8(3, 0).u16(0).u32(0).f32(0, 0, 0).f32(0).buffer) as SurfaceMessage;
  assert.equal(message.vertices.length + message.triangles.length, 0);
});

test("what is cut short anywhere is refused, never read beyond its end", () => {
  for (const whole of [state(2), oriented(), cloud(15), surface(2), past()]) {
    for (let bytes = 0; bytes < whole.byteLength; bytes += 1) {
      assert.throws(() => decode(whole.slice(0, bytes)), DecodeError, `${bytes} of ${whole.byteLength}`);
    }
    assert.doesNotThrow(() => decode(whole));
  }
});

test("counts that cannot be are refused", () => {
  const huge = cloud(3);
  new DataView(huge).setUint32(4, 0xffffffff, true);
  assert.throws(() => decode(huge), DecodeError);
  assert.throws(() => decode(new Writer().u8(9).buffer), /kind 9/);
});

test("a state tells of a tool that turns, after how the hand is held", () => {
  const held = new Writer().f32(0, 0.6, 0, 0.8).f32(0.5, 0.5, 0.5, 0.5).f32(0.25, 0.5).f32(1, 2, 3).f32(-4);
  const bytes = new Uint8Array([...new Uint8Array(state(1)), ...new Uint8Array(held.buffer)]);
  new DataView(bytes.buffer).setUint32(4, Flag.oriented | Flag.holdsTool, true);
  const message = decode(bytes.buffer) as StateMessage;
  assert.deepEqual(message.orientation, [0, Math.fround(0.6), 0, Math.fround(0.8)]);
  assert.deepEqual(message.tool, { orientation: [0.5, 0.5, 0.5, 0.5], opening: 0.25, handOpening: 0.5, torque: [1, 2, 3], grip: -4 });
  assert.throws(() => decode(bytes.buffer.slice(0, -1)), DecodeError);
});

test("a tool is its samples, and a mesh's faces", () => {
  const writer = new Writer().u8(5, 1).u16(0).u32(2).u32(1).f32(1, 0, 0);
  writer.f32(1, 2, 3, 0.5, -1).f32(4, 5, 6, 0, 1).f32(0, 0, 0, 1, 0, 0, 0, 1, 0);
  const tool = decode(writer.buffer) as ToolMessage;
  assert.equal(tool.device, 1);
  assert.deepEqual(tool.axis, [1, 0, 0]);
  assert.deepEqual([...tool.samples], [1, 2, 3, 0.5, -1, 4, 5, 6, 0, 1]);
  assert.deepEqual([...tool.faces], [0, 0, 0, 1, 0, 0, 0, 1, 0]);
  assert.throws(() => decode(writer.buffer.slice(0, -4)), DecodeError);
});
