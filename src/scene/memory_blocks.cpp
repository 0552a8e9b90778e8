// Divides a cloud in memory into blocks, all of which are listed from the start.
#include <utility>

#include "palpate/scene/on_demand.hpp"
#include "prepare/place.hpp"
#include "scene/block_supply.hpp"

namespace palpate {
namespace {

class MemoryBlocks final : public BlockSupply {
 public:
  MemoryBlocks(std::shared_ptr<const PointCloud> cloud, const PrepareOptions& options,
               const Eigen::Isometry3d& pose)
      : cloud_(std::move(cloud)),
        placed_(place(*cloud_, options, pose)),
        blocks_(placed_, options) {}

  [[nodiscard]] const CloudFacts& facts() const override { return blocks_.facts(); }
  [[nodiscard]] std::size_t points() const override { return cloud_->size(); }
  [[nodiscard]] Eigen::Vector3d origin() const override { return placed_.cloud().origin; }
  [[nodiscard]] Eigen::Vector3d start() const override { return facts().extent.center(); }
  [[nodiscard]] std::shared_ptr<const PointCloud> overview() const override { return nullptr; }
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

 private:
  std::shared_ptr<const PointCloud> cloud_;
  Placed placed_;
  Blocks blocks_;
};

}  // namespace

bool OnDemand::suits(const PointCloud& cloud, const PrepareOptions& options) {
  if (cloud.width != 0) return false;
  std::size_t kept = options.clip ? 0 : cloud.size();
  for (std::size_t i = 0; options.clip && i < cloud.size(); ++i) {
    kept += options.clip->contains(cloud.point(i)) ? 1 : 0;
  }
  return goes_by_blocks(kept, options);
}

std::unique_ptr<BlockSupply> blocks_of(std::shared_ptr<const PointCloud> cloud,
                                       const PrepareOptions& options,
                                       const Eigen::Isometry3d& T_world_sensor) {
  return std::make_unique<MemoryBlocks>(std::move(cloud), options, T_world_sensor);
}

}  // namespace palpate
