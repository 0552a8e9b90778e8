// Writes what a depth camera on a robot published, by others' encoder, definitions and writer: camera.mjs FILE none|lz4|zstd.
// 2 s at 30 Hz of a plane 0.5 m away (160 x 120 pixels, 16UC1) with its CameraInfo, colour images beside them, and transforms:
// the camera is 0.1 m above "base", which moves by 0.05 m/s along x of "odom" and is told 40 ms late.
import { McapWriter } from "@mcap/core";
import { stringify } from "@foxglove/rosmsg";
import { ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { compressors, fileOf, withParts } from "./common.mjs";

const [path, kind] = process.argv.slice(2);
const { writable, close } = await fileOf(path);
const compress = await compressors();
const writer = new McapWriter({ writable, chunkSize: 200_000, compressChunk: compress[kind] });
await writer.start({ profile: "ros2", library: "@mcap/core" });

const width = 160;
const height = 120;
const start = 1_700_000_000_000_000_000n;
const at = (time) => ({ sec: Number(time / 1_000_000_000n), nanosec: Number(time % 1_000_000_000n) });

async function topic(name, type) {
  const definitions = withParts(ros2jazzy, type);
  const encoder = new MessageWriter(definitions);
  const schemaId = await writer.registerSchema({
    name: type.replace("/", "/msg/"), encoding: "ros2msg", data: new TextEncoder().encode(stringify(definitions)) });
  const channelId = await writer.registerChannel({ schemaId, topic: name, messageEncoding: "cdr", metadata: new Map() });
  let sequence = 0;
  return (time, message) => writer.addMessage({
    channelId, sequence: sequence++, logTime: time, publishTime: time, data: encoder.writeMessage(message) });
}

const image = await topic("/camera/depth/image_rect_raw", "sensor_msgs/Image");
const info = await topic("/camera/depth/camera_info", "sensor_msgs/CameraInfo");
const color = await topic("/camera/color/image_raw", "sensor_msgs/Image");
const tf = await topic("/tf", "tf2_msgs/TFMessage");
const tfStatic = await topic("/tf_static", "tf2_msgs/TFMessage");
const still = { x: 0, y: 0, z: 0, w: 1 };
const transform = (time, parent, child, translation) => ({ transforms: [{
  header: { stamp: at(time), frame_id: parent }, child_frame_id: child, transform: { translation, rotation: still } }] });

// A plane of 0.5 m with a noise of 1 mm that repeats bit for bit.
let seed = 1;
const noise = () => ((seed = (seed * 16807) % 2147483647) % 3) - 1;
const focal = 150;
const k = [focal, 0, width / 2, 0, focal, height / 2, 0, 0, 1];
const p = [focal, 0, width / 2, 0, 0, focal, height / 2, 0, 0, 0, 1, 0];
await tfStatic(start, transform(start, "base", "camera", { x: 0, y: 0, z: 0.1 }));
for (let i = 0; i < 60; ++i) {
  const time = start + (BigInt(i) * 1_000_000_000n) / 30n;
  const header = { stamp: at(time), frame_id: "camera" };
  const depth = Uint16Array.from({ length: width * height }, () => 500 + noise());
  await image(time + 2_000_000n, { header, height, width, encoding: "16UC1", is_bigendian: 0, step: 2 * width,
    data: new Uint8Array(depth.buffer) });
  await info(time + 3_000_000n, { header, height, width, distortion_model: "plumb_bob", d: [0, 0, 0, 0, 0], k,
    r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p, binning_x: 0, binning_y: 0,
    roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false } });
  if (i % 3 === 0) {
    await color(time + 4_000_000n, { header, height, width, encoding: "rgb8", is_bigendian: 0, step: 3 * width,
      data: new Uint8Array(3 * width * height) });
  }
  await tf(time + 40_000_000n, transform(time, "odom", "base", { x: (0.05 * i) / 30, y: 0, z: 0 }));
}
await writer.end();
await close();
