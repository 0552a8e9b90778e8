// Reads COPC files as point stores.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "geometry/store_nodes.hpp"
#include "io/cloud_builder.hpp"
#include "io/copc.hpp"
#include "io/las_coordinates.hpp"
#include "io/units/file_unit.hpp"

namespace palpate::io {
namespace {

class CopcStore final : public PointStore {
 public:
  CopcStore(const std::filesystem::path& path, const ReadOptions& options)
      : options_(options),
        file_(path),
        bytes_(read_las_head(file_)),
        header_(read_las_header({bytes_.span(), path.string(), options_})),
        head_(in_las_unit({bytes_.span(), path.string(), options_}, header_)),
        scale_(head_.scale().cwiseProduct(header_.scale)),
        offset_(head_.scale().cwiseProduct(header_.offset)) {
    std::optional<Copc> copc = read_copc(head_, header_, parts_of(file_));
    if (!copc) return;
    nodes_ = std::move(copc->nodes);
    std::ranges::sort(nodes_, {}, &StoredNode::offset);
    for (const StoredNode& each : nodes_) layout_.nodes.push_back(each.node);
    layout_.unit = head_.unit;
    layout_.format = "COPC, " + header_.name() + words_of(head_.unit);
    layout_.lower = head_.scale().array() * (copc->center.array() - copc->half_size);
    layout_.edge = head_.unit.plan * 2 * copc->half_size;
    layout_.flatness = head_.unit.height / head_.unit.plan;
    layout_.spacing = head_.unit.plan * copc->spacing;
    layout_.points = header_.points;
    learn_from_sample();
  }

  [[nodiscard]] const Layout& layout() const override { return layout_; }

  [[nodiscard]] PointCloud read(std::size_t node) const override {
    PointCloud cloud;
    cloud.origin = layout_.origin;
    const std::vector<LasPoint> points = points_of(node);
    cloud.positions.reserve(points.size());
    if (has_intensities_) cloud.intensities.reserve(points.size());
    for (const LasPoint& point : points) {
      const Eigen::Vector3d p = position(point);
      if (point.withheld || !is_usable(p)) continue;
      cloud.positions.emplace_back((p - layout_.origin).cast<float>());
      if (has_intensities_) cloud.intensities.push_back(point.intensity);
      if (colors_.largest > 0) cloud.colors.push_back(colors_(point.color));
    }
    return cloud;
  }

 private:
  [[nodiscard]] std::vector<LasPoint> points_of(std::size_t node) const {
    const StoredNode& stored = nodes_[node];
    if (stored.node.points == 0) return {};
    const Bytes bytes = file_.read(stored.offset, stored.bytes, name_of(stored.node));
    return decode_node(head_, header_, bytes.span(), stored);
  }

  [[nodiscard]] Eigen::Vector3d position(const LasPoint& point) const {
    const Eigen::Vector3d numbers(point.number[0], point.number[1], point.number[2]);
    return numbers.cwiseProduct(scale_) + offset_;
  }

  void learn_from_sample() {
    if (layout_.points == 0) return;
    const std::vector<LasPoint> points = points_of(detail::coarsest_node(layout_));
    layout_.origin =
        choose_origin(points.size(), [&](std::size_t i) { return position(points[i]); });
    for (const LasPoint& point : points) {
      has_intensities_ = has_intensities_ || point.intensity > 0;
      colors_.largest = std::max<double>(colors_.largest, std::ranges::max(point.color));
    }
  }

  ReadOptions options_;
  OpenFile file_;
  Bytes bytes_;
  LasHeader header_;
  Input head_;
  Eigen::Vector3d scale_;          // m
  Eigen::Vector3d offset_;         // m
  std::vector<StoredNode> nodes_;  // by their offsets
  bool has_intensities_ = false;
  ColorRule colors_;  // 0: without
  Layout layout_;
};

}  // namespace

std::shared_ptr<const PointStore> open_copc(const std::filesystem::path& path,
                                            const ReadOptions& options) {
  auto store = std::make_shared<const CopcStore>(path, options);
  return store->layout().nodes.empty() ? nullptr : store;
}

}  // namespace palpate::io
