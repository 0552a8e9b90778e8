// Divides a cloud in memory into blocks, all of which are listed from the start.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "large/block_supply.hpp"
#include "palpate/scene/on_demand.hpp"
#include "prepare/place.hpp"
#include "prepare/surfels.hpp"
#include "refine/refinements.hpp"

namespace palpate {
namespace {

// Points that one core prepares in 0.2 to 0.8 s (3 to 12 us each: measured on a scanned statue and
// on a survey with trees). A person waits for more.
constexpr std::size_t kMostWaitedFor = std::size_t{1} << 16;

// Blocks that serve until all is prepared together are cubes of 24 R instead of 96: the survey's
// first block held half of its points, 270 000, and took 7.5 s on a busy machine.
constexpr int kHalvings = 2;

// Points of an overview: more than a page without a graphics card draws of what moves, 40 000.
constexpr std::size_t kMostInOverview = std::size_t{1} << 16;

class MemoryBlocks final : public BlockSupply {
 public:
  MemoryBlocks(std::shared_ptr<const PointCloud> cloud, const PrepareOptions& options,
               const Eigen::Isometry3d& pose)
      : cloud_(std::move(cloud)),
        options_(options),
        placed_(place(*cloud_, options, pose)),
        together_(!goes_by_blocks(placed_.cloud().size(), options)),
        blocks_(placed_, options, together_ ? kHalvings : 0) {}

  [[nodiscard]] const CloudFacts& facts() const override { return blocks_.facts(); }
  [[nodiscard]] std::size_t points() const override { return cloud_->size(); }
  [[nodiscard]] Eigen::Vector3d origin() const override { return placed_.cloud().origin; }
  [[nodiscard]] Eigen::Vector3d start() const override { return facts().extent.center(); }
  [[nodiscard]] std::shared_ptr<const PointCloud> overview(
      std::span<const CloudBlock> blocks) const override;
  [[nodiscard]] bool is_whole() const override { return true; }

  [[nodiscard]] std::vector<Box> list(std::span<const Ball> /*tools*/, double /*near*/,
                                      std::vector<CloudBlock>& blocks) override {
    const Division& division = blocks_.division();
    for (std::size_t k = blocks.size(); k < division.size(); ++k) {
      blocks.emplace_back().key = division.key(k);
      blocks.back().box = division.box(k);
    }
    return {};
  }

  [[nodiscard]] bool has_room(std::span<const CloudBlock> /*blocks*/) const override {
    return true;
  }

  void prepare(CloudBlock& block) override {
    block.piece = blocks_.prepare(*blocks_.division().find(block.key));
  }

  [[nodiscard]] bool comes_together() const override { return together_; }
  [[nodiscard]] Prepared prepare_together(const detail::Progress& progress) const override {
    PrepareOptions options = options_;
    options.progress = progress;
    return prepare_at_once(placed_, options, refinements(), {.points_in = cloud_->size()});
  }

 private:
  std::shared_ptr<const PointCloud> cloud_;
  PrepareOptions options_;
  Placed placed_;
  bool together_;
  Blocks blocks_;
};

std::shared_ptr<const PointCloud> MemoryBlocks::overview(std::span<const CloudBlock> blocks) const {
  const PointCloud& cloud = placed_.cloud();
  const auto is_shown = [&](const CloudBlock& block) {
    return block.state == CloudBlock::State::shown;
  };
  if (std::ranges::all_of(blocks, is_shown)) return nullptr;
  std::vector<Box> shown;
  for (const CloudBlock& block : blocks) {
    if (is_shown(block)) shown.push_back(block.box);
  }
  std::vector<std::uint32_t> kept;
  const std::size_t stride = cloud.size() / kMostInOverview + 1;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    const Eigen::Vector3d point = cloud.point(i);
    const auto holds = [&](const Box& box) { return box.contains(point); };
    if (std::ranges::none_of(shown, holds)) kept.push_back(static_cast<std::uint32_t>(i));
  }
  return std::make_shared<const PointCloud>(select(cloud, kept));
}

}  // namespace

bool OnDemand::suits(const PointCloud& cloud, const PrepareOptions& options) {
  if (cloud.width != 0) return false;
  std::size_t kept = options.clip ? 0 : cloud.size();
  for (std::size_t i = 0; options.clip && i < cloud.size(); ++i) {
    kept += options.clip->contains(cloud.point(i)) ? 1 : 0;
  }
  return kept > kMostWaitedFor && can_go_by_blocks(options);
}

std::unique_ptr<BlockSupply> blocks_of(std::shared_ptr<const PointCloud> cloud,
                                       const PrepareOptions& options,
                                       const Eigen::Isometry3d& T_world_sensor) {
  return std::make_unique<MemoryBlocks>(std::move(cloud), options, T_world_sensor);
}

}  // namespace palpate
