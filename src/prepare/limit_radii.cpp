// Lets support radii grow slowly over the surface.
#include "prepare/limit_radii.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "geometry/neighborhoods.hpp"
#include "geometry/parallel.hpp"
#include "prepare/point_fits.hpp"

namespace palpate {
namespace {

constexpr float kMatters = 0.8f;  // of the point's R: only a smaller limit is applied; judgement
constexpr std::uint32_t kBlockPoints = 64;  // that share one list of leaves; judgement, for speed
constexpr float kPlane = 0.5f;   // confidence from which on a point has a plane; judgement
constexpr float kResiduals = 3;  // off the plane, in its residuals: three sigma
constexpr float kOff = 0.12f;    // off the plane, of the distance (7 degrees); judgement

/// The limits of one block after another.
class Limiter {
 public:
  Limiter(const CellGrid& grid, float slope, const std::vector<float>& radii,
          const std::vector<float>& smallest, const PointFits* own)
      : grid_(grid), slope_(slope), radii_(radii), smallest_(smallest), own_(own) {}

  /// limits: of all points; those of the block are written.
  void limit(const detail::Block& block, std::vector<float>& limits) {
    find_leaves(block);
    for (std::uint32_t i = block.begin; i < block.end; ++i) limits[i] = limit_at(i);
  }

 private:
  /// A leaf and the least that its points can limit those of the block to, m.
  struct Leaf {
    float bound;
    std::uint32_t cell;
  };

  /// The leaves that may limit a point of the block, the strictest first.
  void find_leaves(const detail::Block& block) {
    const auto own = radii_.begin();
    const float largest = kMatters * *std::max_element(own + block.begin, own + block.end);
    leaves_.clear();
    std::array<std::uint32_t, CellGrid::kMaxStack> stack;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const std::uint32_t index = stack[--open];
      if (smallest_[index] >= largest) continue;
      const CellGrid::Cell& cell = grid_.cells()[index];
      const float squared = detail::squared_distance(cell, block.lower, block.upper);
      const float bound = smallest_[index] + slope_ * std::sqrt(squared);
      if (bound >= largest) continue;
      for (std::uint32_t k = 0; k < cell.children; ++k) stack[open++] = cell.first_child + k;
      if (cell.children == 0) leaves_.push_back({bound, index});
    }
    std::sort(leaves_.begin(), leaves_.end(),
              [](const Leaf& a, const Leaf& b) { return a.bound < b.bound; });
  }

  /// min_j (R_j + slope * distance), but for points j on the plane of i, where `own` is given.
  [[nodiscard]] float limit_at(std::uint32_t i) const {
    const Eigen::Vector3f& p = grid_.points()[i];
    const float matters = kMatters * radii_[i];
    float limit = matters;
    for (const Leaf& leaf : leaves_) {
      if (leaf.bound >= limit) break;
      const CellGrid::Cell& cell = grid_.cells()[leaf.cell];
      const float bound = slope_ * std::sqrt(detail::squared_distance(cell, p));
      if (smallest_[leaf.cell] + bound >= limit) continue;
      for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
        const float distance = std::sqrt(detail::squared_distance(grid_.points()[j], p));
        const float limited = radii_[j] + slope_ * distance;
        if (limited < limit && !on_plane(i, j, distance)) limit = limited;
      }
    }
    return limit < matters ? limit : radii_[i];
  }

  /// Does j lie on the plane of i, within noise?
  [[nodiscard]] bool on_plane(std::uint32_t i, std::uint32_t j, float distance) const {
    if (!own_ || own_->confidences[i] < kPlane) return false;
    const float off = std::abs(own_->normals[i].dot(grid_.points()[j] - grid_.points()[i]));
    return off <= std::max(kResiduals * own_->residuals[i], kOff * distance);
  }

  const CellGrid& grid_;
  float slope_;  // of R over distance
  const std::vector<float>& radii_;
  const std::vector<float>& smallest_;
  const PointFits* own_;
  std::vector<Leaf> leaves_;
};

}  // namespace

void limit_radii(const CellGrid& grid, float slope, std::vector<float>& radii,
                 const PointFits* own) {
  if (radii.empty()) return;
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  if (*low >= kMatters * *high) return;
  const std::vector<float> smallest = detail::smallest_in_cells(grid, radii);
  const std::vector<detail::Block> blocks = detail::make_blocks(grid, kBlockPoints);
  std::vector<float> limited(radii.size());
  detail::parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    Limiter limiter(grid, slope, radii, smallest, own);
    for (std::size_t b = begin; b < end; ++b) limiter.limit(blocks[b], limited);
  });
  radii = std::move(limited);
}

}  // namespace palpate
