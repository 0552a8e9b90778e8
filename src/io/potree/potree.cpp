// Opens Potree 2.0 stores and reads their nodes.
#include "io/potree/potree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/store_nodes.hpp"
#include "io/cloud_builder.hpp"
#include "io/file_bytes.hpp"
#include "io/potree/hierarchy.hpp"
#include "io/potree/metadata.hpp"
#include "io/potree/points.hpp"
#include "io/units/file_unit.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.json";
constexpr double kSmallestEdge = 1e-9;  // m: atoms are larger (judgement)

// The largest number of an attribute: of all points, where the metadata states it, else of a
// sample.
template <class NumberOf>
double largest_of(const std::optional<potree::Attribute>& attribute,
                  const std::vector<potree::RawPoint>& sample, const NumberOf& number_of) {
  if (!attribute) return 0;
  double largest = attribute->largest;
  if (largest > 0) return largest;
  for (const potree::RawPoint& p : sample) largest = std::max(largest, number_of(p));
  return largest;
}

class PotreeStore final : public PointStore {
 public:
  PotreeStore(const fs::path& folder, const potree::Metadata& metadata,
              std::vector<StoredNode> nodes, const Input& input)
      : metadata_(metadata),
        scale_(input.scale().cwiseProduct(metadata.scale)),
        offset_(input.scale().cwiseProduct(metadata.offset)),
        nodes_(std::move(nodes)),
        octree_(folder / "octree.bin") {
    check_nodes(nodes_, metadata_, octree_.name(), octree_.size());
    layout_.unit = input.unit;
    layout_.format = fmt::format("Potree 2.0, {}{}", metadata_.packed ? "BROTLI" : "DEFAULT",
                                 input.options.length ? "" : words_of(input.unit));
    layout_.lower = input.scale().cwiseProduct(metadata_.lower);
    layout_.edge = input.unit.plan * metadata_.edge;
    layout_.flatness = input.unit.height / input.unit.plan;
    layout_.spacing = input.unit.plan * metadata_.spacing;
    if (!is_usable(layout_.lower) || !(layout_.edge >= kSmallestEdge) ||
        !(layout_.edge <= kLargestCoordinate)) {
      throw Error(fmt::format("{}: no cloud is {} m long or so far away. Give another scale.",
                              folder.string(), layout_.edge));
    }
    for (const StoredNode& each : nodes_) {
      layout_.nodes.push_back(each.node);
      layout_.points += each.node.points;
    }
    learn_from_sample();
  }

  [[nodiscard]] const Layout& layout() const override { return layout_; }

  [[nodiscard]] PointCloud read(std::size_t node) const override {
    const std::vector<potree::RawPoint> points = raw(node);
    PointCloud cloud;
    cloud.origin = layout_.origin;
    cloud.positions.reserve(points.size());
    if (colors_.largest > 0) cloud.colors.reserve(points.size());
    if (has_intensities_) cloud.intensities.reserve(points.size());
    for (const potree::RawPoint& point : points) {
      const Eigen::Vector3d p = position(point);
      if (!is_usable(p)) continue;
      cloud.positions.emplace_back((p - cloud.origin).cast<float>());
      if (colors_.largest > 0) cloud.colors.push_back(colors_(point.color));
      if (has_intensities_) cloud.intensities.push_back(point.intensity);
    }
    return cloud;
  }

 private:
  [[nodiscard]] std::vector<potree::RawPoint> raw(std::size_t node) const {
    const StoredNode& stored = nodes_[node];
    const Bytes bytes =
        octree_.read(stored.offset, stored.bytes, "node " + potree::name_of(stored.node));
    return decode(metadata_, stored, bytes.span(), octree_.name());
  }

  [[nodiscard]] Eigen::Vector3d position(const potree::RawPoint& point) const {
    const Eigen::Vector3d number(point.number[0], point.number[1], point.number[2]);
    return number.cwiseProduct(scale_) + offset_;
  }

  void learn_from_sample() {
    if (layout_.points == 0) return;
    const std::vector<potree::RawPoint> sample = raw(detail::coarsest_node(layout_));
    layout_.origin =
        choose_origin(sample.size(), [&](std::size_t i) { return position(sample[i]); });
    colors_.largest = largest_of(metadata_.color, sample, [](const potree::RawPoint& p) {
      return static_cast<double>(std::ranges::max(p.color));
    });
    has_intensities_ = 0 < largest_of(metadata_.intensity, sample, [](const potree::RawPoint& p) {
                         return static_cast<double>(std::abs(p.intensity));
                       });
  }

  potree::Metadata metadata_;
  Eigen::Vector3d scale_;   // m
  Eigen::Vector3d offset_;  // m
  std::vector<StoredNode> nodes_;
  OpenFile octree_;
  Layout layout_;
  bool has_intensities_ = false;
  ColorRule colors_;  // 0: without
};

// What to do with a folder that is no store.
std::string instead_of(const fs::path& folder) {
  std::error_code unknown;
  for (const char* const list : {"sequence.json", "depth.txt", "associations.txt"}) {
    if (!fs::exists(folder / list, unknown)) continue;
    return fmt::format("Its recorded frames are sequence:{}.", folder.string());
  }
  fs::path cloud;
  for (const auto& each : fs::directory_iterator(folder, unknown)) {
    const std::string type = extension(each.path().string());
    if (type == ".mcap") return fmt::format("What was recorded in it is bag:{}.", folder.string());
    constexpr std::array<std::string_view, 9> kClouds{".ply", ".pcd", ".las", ".laz", ".e57",
                                                      ".obj", ".stl", ".glb", ".xyz"};
    const bool first = cloud.empty() || each.path() < cloud;
    if (std::ranges::count(kClouds, type) > 0 && first) cloud = each.path();
  }
  if (unknown) return fmt::format("It cannot be listed: {}.", unknown.message());
  if (!cloud.empty()) return fmt::format("Give a file in it, such as {}.", cloud.string());
  return "Give a file, or a folder that holds such a store, recorded frames (sequence:FOLDER) or a "
         "ROS 2 bag (bag:FOLDER).";
}

}  // namespace

bool is_potree(const fs::path& path) {
  std::error_code unknown;
  const fs::path file = fs::is_directory(path, unknown) ? path / kMetadata : path;
  return file.filename() == kMetadata && fs::is_regular_file(file, unknown);
}

std::shared_ptr<const PointStore> open_potree(const fs::path& path, const ReadOptions& options) {
  const fs::path folder = path.filename() == kMetadata ? path.parent_path() : path;
  std::error_code unknown;
  if (!fs::is_regular_file(folder / kMetadata, unknown)) {
    throw Error(fmt::format("{}: is a folder, but no Potree store, which holds metadata.json. {}",
                            folder.string(), instead_of(folder)));
  }
  const auto input_of = [&](const Bytes& bytes, const char* name) {
    return Input{bytes.span(), (folder / name).string(), options};
  };
  const Bytes description = read_bytes(folder / kMetadata);
  const potree::Metadata metadata = potree::read_metadata(input_of(description, kMetadata));
  const StatedUnits stated = units_in_projection(metadata.projection);
  const Input input = in_stated_unit(input_of(description, kMetadata), stated, "its projection");
  if (stated.degrees) {
    fail(input, "its coordinates are degrees of longitude and latitude, as it says",
         "Make it again of a cloud that is projected to metres");
  }
  const Bytes hierarchy = read_bytes(folder / "hierarchy.bin");
  std::vector<StoredNode> nodes =
      potree::read_hierarchy(input_of(hierarchy, "hierarchy.bin"), metadata);
  return std::make_shared<PotreeStore>(folder, metadata, std::move(nodes), input);
}

}  // namespace palpate::io
