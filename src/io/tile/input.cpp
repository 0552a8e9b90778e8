// Opens the clouds that are tiled, and reads whole those that do not come in pieces.
#include "io/tile/input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/file_bytes.hpp"
#include "io/tile/cell_counter.hpp"
#include "io/tile/frame.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::string_view kTerrain = "synthetic:terrain:";

Box box_of(const PointCloud& cloud) {
  Box box;
  for (std::size_t i = 0; i < cloud.size(); ++i) box.extend(cloud.point(i));
  return box;
}

// Brings intensities to 16 bits: shares of 1, numbers up to 65535 as they are, others by their
// largest.
double intensity_factor(const PointCloud& cloud) {
  constexpr double kLargest = 65535;
  float most = 0;
  for (const float each : cloud.intensities) most = std::max(most, each);
  if (most <= 1) return kLargest;
  return most <= kLargest ? 1 : kLargest / static_cast<double>(most);
}

class WholeCloud final : public TileInput {
 public:
  WholeCloud(const std::string& path, double scale) : path_(path) {
    options_.scale = scale;
    const CloudFile file = read_cloud_file(path_, options_);
    facts_.name = path;
    facts_.format = file.format;
    facts_.points = file.cloud.size();
    facts_.box = box_of(file.cloud);
    facts_.scale = Eigen::Vector3d::Constant(step_for(facts_.box.size().maxCoeff()));
    facts_.offset = facts_.box.lower;
    facts_.intensities = !file.cloud.intensities.empty();
    facts_.colors = !file.cloud.colors.empty();
    intensity_factor_ = intensity_factor(file.cloud);
  }

  [[nodiscard]] const Facts& facts() const override { return facts_; }
  [[nodiscard]] std::size_t pieces() const override { return 1; }

  [[nodiscard]] std::vector<LasPoint> read(std::size_t) const override {
    const PointCloud cloud = read_cloud_file(path_, options_).cloud;
    std::vector<LasPoint> points(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) points[i] = point_at(cloud, i);
    return points;
  }

 private:
  [[nodiscard]] LasPoint point_at(const PointCloud& cloud, std::size_t i) const {
    constexpr unsigned kByteTo16 = 257;  // 255 becomes 65535
    LasPoint point{};
    const Eigen::Vector3d place = (cloud.point(i) - facts_.offset).cwiseQuotient(facts_.scale);
    for (std::size_t k = 0; k < 3; ++k) {
      point.number[k] = static_cast<std::int32_t>(std::lround(place[static_cast<int>(k)]));
      if (facts_.colors) {
        point.color[k] = static_cast<std::uint16_t>(kByteTo16 * cloud.colors[i][k]);
      }
    }
    if (facts_.intensities) {
      const double scaled = intensity_factor_ * static_cast<double>(cloud.intensities[i]);
      point.intensity = static_cast<std::uint16_t>(std::lround(std::clamp(scaled, 0.0, 65535.0)));
    }
    return point;
  }

  std::string path_;
  ReadOptions options_;
  Facts facts_;
  double intensity_factor_ = 1;
};

std::size_t count_in(const std::string& path) {
  const std::string text = path.substr(std::min(kTerrain.size(), path.size()));
  const std::optional<double> count = parse_number(text);
  if (path.starts_with(kTerrain) && count && *count >= 1 &&
      *count <= static_cast<double>(kMostCounted)) {
    return static_cast<std::size_t>(*count);
  }
  throw Error(
      fmt::format("{}: not a made cloud that is tiled. Give \"synthetic:terrain:N\" with N "
                  "from 1 to {:.1e} points, such as synthetic:terrain:2e7.",
                  path, static_cast<double>(kMostCounted)));
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

std::unique_ptr<TileInput> open_input(const std::string& path, double scale) {
  if (path.starts_with("synthetic:")) return open_terrain(count_in(path));
  if (path == "-") {
    throw Error("standard input cannot be tiled, as it is read more than once. Give a file.");
  }
  const std::string file = split_scan(path).file;
  std::unique_ptr<TileInput> input =
      is_las(file) ? open_las(path, scale) : std::make_unique<WholeCloud>(path, scale);
  return input;
}

}  // namespace palpate::io::tile
