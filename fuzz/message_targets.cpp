// Bytes as messages of every type, and what is made of those that decode.
#include <cmath>
#include <vector>

#include "message/cdr.hpp"
#include "message/depth_images.hpp"
#include "message/display_types.hpp"
#include "message/palpate_types.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "targets.hpp"

namespace palpate::fuzz {
namespace {

using namespace message;
using Bytes = std::span<const std::uint8_t>;

void check(const auto&) {}

void check_frame(const auto& image) {
  DepthFrame frame;
  read_depth(image, frame);
  expect(frame.camera.width > 0 && frame.camera.height > 0, "an image without pixels");
  expect(frame.depth.size() == static_cast<std::size_t>(frame.camera.width) *
                                   static_cast<std::size_t>(frame.camera.height),
         "depths that are not one a pixel");
  for (const float z : frame.depth) expect(std::isfinite(z) && z >= 0, "a depth");
}

void check(const Image& image) {
  check_frame(image);
}

void check(const CompressedImage& image) {
  check_frame(image);
}

void check(const PointCloud2& points) {
  const PointCloud cloud = cloud_of(points);
  const std::size_t n = cloud.size();
  const auto fits = [n](const auto& column) { return column.empty() || column.size() == n; };
  expect(n <= points.data.size(), "more points than bytes");
  expect(fits(cloud.normals) && fits(cloud.colors) && fits(cloud.intensities) && fits(cloud.pixels),
         "column lengths");
  for (const auto& p : cloud.positions) expect(p.allFinite(), "a position that is not finite");
  for (const std::uint32_t pixel : cloud.pixels) {
    expect(pixel < std::uint64_t{cloud.width} * cloud.height, "a pixel outside of the image");
  }
}

void check(const message::CameraInfo& info) {
  for (const bool rectified : {false, true}) {
    try {
      const CameraModel camera = camera_of(info, rectified);
      const Pinhole& p = camera.pinhole;
      expect(p.fx > 0 && p.fy > 0, "a focal length");
      for (const double each : {p.fx, p.fy, p.cx, p.cy}) expect(std::isfinite(each), "a pinhole");
      expect(camera.width >= 0 && camera.height >= 0, "a size");
      const auto& d = camera.distortion;
      for (const double each : {d.k1, d.k2, d.k3, d.p1, d.p2}) {
        expect(std::isfinite(each), "a lens that is not finite");
      }
    } catch (const Error&) {
      continue;
    }
  }
}

void check(const TFMessage& told) {
  Transforms known;
  known.add(told, false);
  known.add(told, true);
  for (const TransformStamped& each : told.transforms) {
    const double stamp = to_seconds(each.header.stamp);
    const auto found = known.find(each.header.frame_id, each.child_frame_id, stamp);
    expect(!found || found->matrix().allFinite(), "a pose that is not finite");
  }
}

// Checks that a decoded message is the same after encoding and decoding again.
template <Message T>
void check_type(Bytes bytes) {
  try {
    T message;
    decode(bytes, message);
    std::vector<std::uint8_t> once;
    encode(message, once);
    expect(once.size() <= bytes.size() + 8 * bytes.size(), "a message that grows");
    T again;
    decode(once, again);
    std::vector<std::uint8_t> twice;
    encode(again, twice);
    expect(once == twice, "a message that is another when encoded");
    check(message);
  } catch (const Error&) {
    return;  // what a reader says to bytes that it cannot use
  }
}

template <Message... T>
void check_types(Bytes bytes) {
  (check_type<T>(bytes), ...);
}

}  // namespace

void check_messages(std::span<const std::byte> bytes) {
  const Bytes same(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  check_types<Bool, Int32, Float64, Float32MultiArray, Float64MultiArray, Point, Vector3,
              PoseStamped, WrenchStamped, TwistStamped, TFMessage, PointCloud2, Image,
              CompressedImage, message::CameraInfo, Joy, JointState, DiagnosticArray, Marker,
              MarkerArray, OmniFeedback, OmniButtonEvent, Tick, ToolStep>(same);
}

}  // namespace palpate::fuzz
