// Reads COPC files as point stores.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "geometry/store_nodes.hpp"
#include "io/cloud_builder.hpp"
#include "io/copc.hpp"

namespace palpate::io {
namespace {

class CopcStore final : public PointStore {
 public:
  CopcStore(const std::filesystem::path& path, double scale)
      : file_(path),
        parts_(parts_of(file_)),
        bytes_(read_las_head(file_)),
        head_{bytes_.span(), path.string(), options_},
        header_(read_las_header(head_)),
        scale_(scale * header_.scale),
        offset_(scale * header_.offset) {
    std::optional<Copc> copc = read_copc(head_, header_, parts_);
    if (!copc) return;
    nodes_ = std::move(copc->nodes);
    std::ranges::sort(nodes_, {}, &CopcNode::place);
    for (const CopcNode& node : nodes_) {
      layout_.nodes.push_back({node.key.level, node.key.cell, node.points});
    }
    layout_.format = "COPC, " + header_.name();
    layout_.lower = scale * (copc->center.array() - copc->half_size);
    layout_.edge = scale * 2 * copc->half_size;
    layout_.spacing = scale * copc->spacing;
    layout_.points = header_.points;
    learn_from_sample();
  }

  [[nodiscard]] const Layout& layout() const override { return layout_; }

  [[nodiscard]] PointCloud read(std::size_t node) const override {
    PointCloud cloud;
    cloud.origin = layout_.origin;
    std::vector<std::array<float, 3>> colors;
    const std::vector<LasPoint> points = points_of(node);
    cloud.positions.reserve(points.size());
    if (has_intensities_) cloud.intensities.reserve(points.size());
    for (const LasPoint& point : points) {
      const Eigen::Vector3d p = place(point);
      if (point.withheld || !is_usable(p)) continue;
      cloud.positions.emplace_back((p - layout_.origin).cast<float>());
      if (has_intensities_) cloud.intensities.push_back(point.intensity);
      if (color_factor_ == 0) continue;
      std::array<float, 3>& color = colors.emplace_back();
      std::ranges::transform(point.color, color.begin(),
                             [&](float value) { return value * color_factor_; });
    }
    cloud.colors = byte_colors(colors, ColorScale::byte);
    return cloud;
  }

 private:
  [[nodiscard]] std::vector<LasPoint> points_of(std::size_t node) const {
    return read_node(head_, header_, parts_, nodes_[node]);
  }

  [[nodiscard]] Eigen::Vector3d place(const LasPoint& point) const {
    const Eigen::Vector3d numbers(point.number[0], point.number[1], point.number[2]);
    return numbers.cwiseProduct(scale_) + offset_;
  }

  void learn_from_sample() {
    if (layout_.points == 0) return;
    const std::vector<LasPoint> points = points_of(detail::coarsest_node(layout_));
    layout_.origin = choose_origin(points.size(), [&](std::size_t i) { return place(points[i]); });
    std::uint16_t most_color = 0;
    for (const LasPoint& point : points) {
      has_intensities_ = has_intensities_ || point.intensity > 0;
      most_color = std::max(most_color, std::ranges::max(point.color));
    }
    if (most_color > 0) color_factor_ = most_color > 255 ? 1.F / 257 : 1.F;
  }

  OpenFile file_;
  Parts parts_;
  ReadOptions options_;
  Bytes bytes_;
  Input head_;
  LasHeader header_;
  Eigen::Vector3d scale_;        // m
  Eigen::Vector3d offset_;       // m
  std::vector<CopcNode> nodes_;  // by their places
  bool has_intensities_ = false;
  float color_factor_ = 0;  // to bytes; 0: without colours
  Layout layout_;
};

}  // namespace

std::shared_ptr<const PointStore> open_copc(const std::filesystem::path& path, double scale) {
  auto store = std::make_shared<const CopcStore>(path, scale);
  return store->layout().nodes.empty() ? nullptr : store;
}

}  // namespace palpate::io
