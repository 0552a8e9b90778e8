#include "io/depth_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/cloud_builder.hpp"
#include "io/progress.hpp"
#include "io/row.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kFarBeyond = 10;  // times the median depth

// 0 when no pixel is valid.
std::size_t median_depth(const DepthImage& image) {
  std::vector<std::uint16_t> valid;
  std::copy_if(image.samples.begin(), image.samples.end(), std::back_inserter(valid),
               [&](std::uint16_t s) { return is_depth(image, s); });
  if (valid.empty()) return 0;
  const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() / 2);
  std::nth_element(valid.begin(), middle, valid.end());
  return *middle;
}

}  // namespace

Pinhole intrinsics_of(const Input& input, const DepthImage& image) {
  if (!input.options.intrinsics) {
    fail(input,
         fmt::format("a depth image of {} x {} pixels, and the camera is not known", image.width,
                     image.height),
         "Give its intrinsics in pixels (--intrinsics fx,fy,cx,cy; a sequence.json or camera file "
         "beside the image may hold them) and the metres of one depth step (--depth-unit)");
  }
  const Pinhole camera = *input.options.intrinsics;
  const bool sane = std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                    std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx != 0 &&
                    camera.fy != 0;
  if (!sane) {
    fail(input,
         fmt::format("intrinsics {},{},{},{} are those of no camera", camera.fx, camera.fy,
                     camera.cx, camera.cy),
         "Give fx,fy,cx,cy in pixels, fx and fy not zero");
  }
  return camera;
}

double unit_of(const Input& input) {
  const double unit = input.options.depth_unit;
  if (std::isfinite(unit) && unit > 0) return unit;
  fail(input, fmt::format("a depth unit of {} metres", unit),
       "Give the metres of one depth step, such as 0.001 for millimetres");
}

bool is_depth(const DepthImage& image, std::uint16_t sample) {
  return sample != 0 && sample < image.largest && sample != 65535;
}

CloudFile cloud_of(const Input& input, const DepthImage& image) {
  const Pinhole camera = intrinsics_of(input, image);
  const double unit = unit_of(input);
  const std::size_t farthest = kFarBeyond * median_depth(image);
  CloudBuilder builder(input, {}, ColorScale::byte, image.samples.size());
  builder.organise(image.width, image.height);
  Progress progress(input.options, image.samples.size());
  Row row{};
  for (std::size_t i = 0; i < image.samples.size(); ++i) {
    progress.at(i);
    const std::uint16_t sample = image.samples[i];
    const bool kept = is_depth(image, sample) && sample <= farthest;
    const double z = kept ? unit * sample : std::nan("");
    row[0] = (static_cast<double>(i % image.width) - camera.cx) * z / camera.fx;
    row[1] = (static_cast<double>(i / image.width) - camera.cy) * z / camera.fy;
    row[2] = z;
    builder.add(row);
  }
  CloudFile file = builder.finish(image.format);
  file.cloud.viewpoint = Eigen::Vector3d::Zero();
  return file;
}

void check_image_size(const Input& input, std::uint64_t width, std::uint64_t height) {
  constexpr std::uint64_t kLargestRatio = 1032;  // of deflate
  constexpr std::uint64_t kWidest = 65536;
  const bool sane = width > 0 && height > 0 && width <= kWidest && height <= kWidest &&
                    2 * width * height / kLargestRatio <= input.bytes.size();
  if (sane) return;
  fail(input,
       fmt::format("{} x {} pixels announced, too many for {} bytes", width, height,
                   input.bytes.size()),
       "The file is cut or damaged: fetch it again");
}

}  // namespace palpate::io
