// Turns ROS camera descriptions and images into CameraModels and depths.
#include "message/depth_images.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/depth_image.hpp"
#include "message/cdr.hpp"
#include "palpate/base/error.hpp"

namespace palpate::message {
namespace {

constexpr double kMillimetre = 1e-3;               // m, of a step in 16UC1 (REP 118)
constexpr std::uint32_t kLargestSide = 1U << 14U;  // pixels (judgement)

using Distortion = CameraModel::Distortion;

// Factor by which a rational lens moves a ray away from the axis, at squared radius s.
double rational(const std::vector<double>& d, double s) {
  return (1 + s * (d[0] + s * (d[1] + s * d[4]))) / (1 + s * (d[5] + s * (d[6] + s * d[7])));
}

// The polynomial in s that comes nearest to rational(), weighted as pixels see it, and how far off
// it is.
Distortion fitted(const std::vector<double>& d, const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  const double x = std::max(p.cx, camera.width - p.cx) / p.fx;
  const double y = std::max(p.cy, camera.height - p.cy) / p.fy;
  const double radius = std::hypot(x, y);
  constexpr int kSamples = 64;
  Eigen::Matrix<double, kSamples, 3> powers;
  Eigen::Matrix<double, kSamples, 1> wanted;
  for (int i = 0; i < kSamples; ++i) {
    const double r = radius * (i + 1) / kSamples;
    const double s = r * r;
    powers.row(i) << r * s, r * s * s, r * s * s * s;
    wanted[i] = r * (rational(d, s) - 1);
  }
  const Eigen::Vector3d k = powers.householderQr().solve(wanted);
  const double off = p.fx * (powers * k - wanted).cwiseAbs().maxCoeff();
  if (!(off < 1)) {
    throw Error(fmt::format(
        "a rational_polynomial lens that is {:.2g} pixels from what palpate can follow; use the "
        "rectified topic (image_rect)",
        off));
  }
  return {.k1 = k[0], .k2 = k[1], .p1 = d[2], .p2 = d[3], .k3 = k[2]};
}

Distortion distortion_of(const CameraInfo& info, const CameraModel& camera) {
  const std::vector<double>& d = info.d;
  if (std::ranges::all_of(d, [](double value) { return value == 0; })) return {};
  if (!std::ranges::all_of(d, [](double value) { return std::isfinite(value); })) {
    throw Error("a lens whose coefficients are not finite; the camera has to be calibrated");
  }
  if (info.distortion_model == "plumb_bob" && d.size() >= 4) {
    return {.k1 = d[0], .k2 = d[1], .p1 = d[2], .p2 = d[3], .k3 = d.size() > 4 ? d[4] : 0};
  }
  if (info.distortion_model == "rational_polynomial" && d.size() >= 8) return fitted(d, camera);
  throw Error(
      fmt::format("a lens of distortion model '{}' with {} coefficients; plumb_bob (4 or 5) and "
                  "rational_polynomial (8) are understood. Use the rectified topic (image_rect)",
                  io::excerpt(info.distortion_model), d.size()));
}

void set_size(DepthFrame& frame, std::uint32_t width, std::uint32_t height) {
  if (width == 0 || height == 0 || width > kLargestSide || height > kLargestSide) {
    throw Error(fmt::format("an image of {} x {} pixels", width, height));
  }
  frame.camera.width = static_cast<int>(width);
  frame.camera.height = static_cast<int>(height);
  frame.depth.resize(static_cast<std::size_t>(width) * height);
  frame.colors.clear();
  frame.cloud.reset();
}

// Row `v` of an image as numbers of type T.
template <class T>
void copy_row(const Image& image, std::size_t v, std::span<T> row) {
  std::memcpy(row.data(), image.data.data() + v * image.step, row.size_bytes());
  if (image.is_bigendian != 0) std::ranges::for_each(row, swap_bytes<T>);
}

// 0: nothing was measured.
float metres_of(float z, std::optional<double> unit) {
  if (unit) z *= static_cast<float>(*unit);
  return std::isfinite(z) && z > 0 ? z : 0.0F;
}

// image_transport's head of compressed depth: how 32-bit depths became 16 bits, z = a / (value -
// b).
struct CompressedHead {
  std::int32_t format = 0;
  float a = 0;
  float b = 0;
};
static_assert(sizeof(CompressedHead) == 12);

io::DepthImage read_png(std::span<const std::uint8_t> bytes) {
  const ReadOptions options;
  return io::read_png({std::as_bytes(bytes), "compressed depth image", options});
}

}  // namespace

CameraModel camera_of(const CameraInfo& info, bool rectified) {
  const bool use_p = rectified && info.p[0] != 0;
  const double bx = std::max(info.binning_x, 1U);
  const double by = std::max(info.binning_y, 1U);
  const double left = info.roi.x_offset;
  const double top = info.roi.y_offset;
  CameraModel camera;
  camera.pinhole = use_p ? Pinhole{info.p[0] / bx, info.p[5] / by, (info.p[2] - left) / bx,
                                   (info.p[6] - top) / by}
                         : Pinhole{info.k[0] / bx, info.k[4] / by, (info.k[2] - left) / bx,
                                   (info.k[5] - top) / by};
  const Pinhole& p = camera.pinhole;
  if (!(std::isfinite(p.fx) && std::isfinite(p.fy) && std::isfinite(p.cx) && std::isfinite(p.cy)) ||
      !(p.fx > 0) || !(p.fy > 0)) {
    throw Error(fmt::format("a camera of {} x {} pixels focal length; it has to be calibrated",
                            p.fx, p.fy));
  }
  const std::uint32_t width = info.roi.width != 0 ? info.roi.width : info.width;
  const std::uint32_t height = info.roi.height != 0 ? info.roi.height : info.height;
  camera.width = static_cast<int>(std::min(width, kLargestSide) / static_cast<std::uint32_t>(bx));
  camera.height = static_cast<int>(std::min(height, kLargestSide) / static_cast<std::uint32_t>(by));
  if (!rectified) camera.distortion = distortion_of(info, camera);
  return camera;
}

namespace {

// Offset of the topic's own name, before "/compressed..." at its end.
std::size_t name_in(const std::string& topic) {
  const std::size_t last = topic.rfind('/');
  if (last == std::string::npos) return topic.size();
  if (last == 0) return 0;
  return topic.compare(last, 11, "/compressed") == 0 ? topic.rfind('/', last - 1) : last;
}

}  // namespace

bool is_rectified(const std::string& topic) {
  return topic.find("rect", name_in(topic)) != std::string::npos;
}

std::string info_topic(const std::string& image_topic) {
  return image_topic.substr(0, name_in(image_topic)) + "/camera_info";
}

void read_depth(const Image& image, DepthFrame& frame, std::optional<double> unit) {
  const bool is_float = image.encoding == "32FC1";
  if (!is_float && image.encoding != "16UC1" && image.encoding != "mono16") {
    throw Error(fmt::format(
        "an image of encoding '{}'; depth comes as 16UC1 (millimetres) or 32FC1 (metres)",
        io::excerpt(image.encoding)));
  }
  const std::size_t row_bytes = static_cast<std::size_t>(image.width) * (is_float ? 4 : 2);
  if (image.step < row_bytes || image.data.size() / std::max(image.step, 1U) < image.height) {
    throw Error(fmt::format("an image of {} x {} pixels in {} bytes, {} a row", image.width,
                            image.height, image.data.size(), image.step));
  }
  set_size(frame, image.width, image.height);
  std::vector<std::uint16_t> steps(is_float ? 0 : image.width);
  for (std::size_t v = 0; v < image.height; ++v) {
    const std::span row(frame.depth.data() + v * image.width, image.width);
    if (is_float) {
      copy_row(image, v, row);
      std::ranges::transform(row, row.begin(), [&](float z) { return metres_of(z, unit); });
    } else {
      copy_row(image, v, std::span(steps));
      to_metres(steps, unit.value_or(kMillimetre), row);
    }
  }
}

void read_depth(const CompressedImage& image, DepthFrame& frame, std::optional<double> unit) {
  const bool has_head = image.format.find("compressedDepth") != std::string::npos;
  if (image.format.find("rvl") != std::string::npos) {
    throw Error("depth compressed by RVL; set the publisher's compressedDepth format to png");
  }
  CompressedHead head;
  std::span<const std::uint8_t> bytes = image.data;
  if (has_head) {
    if (bytes.size() < sizeof(head)) throw Error("a compressed depth image without its head");
    std::memcpy(&head, bytes.data(), sizeof(head));
    bytes = bytes.subspan(sizeof(head));
  }
  const io::DepthImage png = read_png(bytes);
  set_size(frame, static_cast<std::uint32_t>(png.width), static_cast<std::uint32_t>(png.height));
  if (!image.format.starts_with("32FC1"))
    return to_metres(png.samples, unit.value_or(kMillimetre), frame.depth);
  std::ranges::transform(png.samples, frame.depth.begin(), [&](std::uint16_t value) {
    const float z = head.a / (static_cast<float>(value) - head.b);
    return value != 0 ? metres_of(z, unit) : 0.0F;
  });
}

Image image_of(const DepthFrame& frame) {
  Image image;
  image.width = static_cast<std::uint32_t>(frame.camera.width);
  image.height = static_cast<std::uint32_t>(frame.camera.height);
  image.encoding = "32FC1";
  image.step = 4 * image.width;
  image.data.resize(frame.depth.size() * sizeof(float));
  if (!image.data.empty()) std::memcpy(image.data.data(), frame.depth.data(), image.data.size());
  return image;
}

CameraInfo info_of(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  const Distortion& d = camera.distortion;
  CameraInfo info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.d = {d.k1, d.k2, d.p1, d.p2, d.k3};
  info.k = {p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {p.fx, 0, p.cx, 0, 0, p.fy, p.cy, 0, 0, 0, 1, 0};
  return info;
}

}  // namespace palpate::message
