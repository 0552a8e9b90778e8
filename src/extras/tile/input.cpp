// Opens the clouds that are tiled, and reads whole those that do not come in pieces.
#include "extras/tile/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "extras/tile/frame.hpp"
#include "io/file_bytes.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::string_view kTerrain = "synthetic:terrain:";

// Brings intensities to 16 bits: shares of 1, numbers up to 65535 as they are, others by their
// largest.
std::uint16_t intensity_of(double value, double most) {
  constexpr double kLargest = 65535;
  const double factor = most <= 1 ? kLargest : most <= kLargest ? 1 : kLargest / most;
  return static_cast<std::uint16_t>(std::lround(std::clamp(factor * value, 0.0, kLargest)));
}

std::vector<InputPoint> points_of(const PointCloud& cloud) {
  constexpr unsigned kByteTo16 = 257;  // 255 becomes 65535
  std::vector<InputPoint> points(cloud.size());
  float most = 0;
  for (const float each : cloud.intensities) most = std::max(most, each);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position = cloud.point(i);
    if (!cloud.intensities.empty()) {
      points[i].intensity =
          intensity_of(static_cast<double>(cloud.intensities[i]), static_cast<double>(most));
    }
    for (std::size_t k = 0; k < 3 && !cloud.colors.empty(); ++k) {
      points[i].color[k] = static_cast<std::uint16_t>(kByteTo16 * cloud.colors[i][k]);
    }
  }
  return points;
}

TileInput open_whole(const std::string& path, const ReadOptions& options) {
  const CloudFile file = read_cloud_file(path, options);
  TileInput input{.name = path, .format = file.format, .unit = file.unit};
  input.points = file.cloud.size();
  for (std::size_t i = 0; i < file.cloud.size(); ++i) input.box.extend(file.cloud.point(i));
  input.origin = input.box.lower;
  input.length = input.box.size().maxCoeff();
  input.read = [path, options](std::size_t) { return points_of(read_cloud(path, options)); };
  return input;
}

std::size_t count_in(const std::string& path) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();  // points of a store
  const std::string text = path.substr(std::min(kTerrain.size(), path.size()));
  const std::optional<double> count = parse_number(text);
  if (path.starts_with(kTerrain) && count && *count >= 1 && *count <= kMost) {
    return static_cast<std::size_t>(*count);
  }
  throw Error(
      fmt::format("{}: not a made cloud that is tiled. Give \"synthetic:terrain:N\" with N "
                  "from 1 to {:.1e} points, such as synthetic:terrain:2e7.",
                  path, kMost));
}

bool is_las(const std::string& path) {
  const OpenFile file(path);
  const Bytes head = file.read(0, std::min<std::size_t>(file.size(), 4));
  return std::string_view(reinterpret_cast<const char*>(head.span().data()), head.size()) == "LASF";
}

}  // namespace

double step_for(double length) {
  constexpr double kStep = 1e-3;   // m; finer than any survey of so long a cloud (judgement)
  constexpr double kShare = 1e-6;  // of the length; a float has 6e-8 (judgement)
  const double share = length > 0 ? std::pow(10.0, std::floor(std::log10(kShare * length))) : kStep;
  double step = std::min(kStep, share);
  while (length / step >= std::ldexp(1.0, kMostBits)) step *= 10;
  return step;
}

TileInput open_input(const std::string& path, const ReadOptions& options) {
  if (path.starts_with("synthetic:")) return make_terrain(count_in(path));
  if (path == "-") {
    throw Error("standard input cannot be tiled, as it is read more than once. Give a file.");
  }
  return is_las(split_scan(path).file) ? open_las(path, options) : open_whole(path, options);
}

}  // namespace palpate::io::tile
