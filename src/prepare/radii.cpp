#include "prepare/radii.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "geometry/neighborhoods.hpp"
#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/lines.hpp"
#include "prepare/places.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
namespace {

constexpr std::size_t kLooked = 9;  // itself, and others of which some may share its place

// Random points have 0.52; scanners' meshes, frames and jittered grids 0.71 and above.
constexpr double kIrregular = 0.65;

}  // namespace

double nearest_share(const CellGrid& grid, std::span<const float> spacings) {
  std::vector<float> shares;
  std::vector<CellGrid::Neighbor> near;
  each_sample(grid, [&](std::uint32_t i) {
    grid.nearest(grid.points()[i], kLooked, near);
    const auto other =
        std::ranges::find_if(near, [](const auto& found) { return found.squared_distance > 0; });
    if (other != near.end()) shares.push_back(std::sqrt(other->squared_distance) / spacings[i]);
  });
  return shares.empty() ? 1 : median(shares);
}

bool is_irregular(const CellGrid& grid, std::span<const float> spacings) {
  return nearest_share(grid, spacings) < kIrregular;
}

namespace {

constexpr float kMultiple = 2.5f;    // R over the gap
constexpr float kFaint = 2.5f;       // sums of weights: 5.8 on a square grid
constexpr float kFirstReach = 1.5f;  // radii
constexpr int kWidenings = 2;        // of the reach, each twofold: gaps up to three radii

}  // namespace

std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, OwnSheets& own) {
  std::vector<std::uint32_t> faint;
  for (std::uint32_t i = 0; i < radii.size(); ++i) {
    if (sums[i] < kFaint) faint.push_back(i);
  }
  std::vector<std::uint8_t> raised(faint.size());
  const std::vector<float> before = radii;
  detail::parallel_ranges(faint.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    std::vector<CellGrid::Neighbor> nearest;
    SheetFitter fitter;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = faint[k];
      const Line line = line_at(grid, i, nearest);
      const float gap = gap_across(grid, i, line, kFirstReach * before[i], kWidenings, near);
      const float wanted = kMultiple * gap;
      if (!(wanted > before[i])) continue;
      const SheetFit fit = fitter.fit(grid, grid.points()[i], static_cast<double>(wanted),
                                      static_cast<double>(spacings[i]));
      if (!fit.is_sheet(static_cast<double>(wanted), 0)) continue;
      radii[i] = wanted;
      spacings[i] = std::max(spacings[i], wanted / kMultiple);
      own.normals[i] = fit.normal.cast<float>();
      own.confidences[i] = static_cast<float>(fit.planarity);
      own.residuals[i] = static_cast<float>(fit.residual);
      own.bends[i] = static_cast<float>(fit.bend);
      raised[k] = 1;
    }
  });
  return static_cast<std::size_t>(std::ranges::count(raised, 1));
}

namespace {

constexpr float kMatters = 0.8f;  // of the own R: a smaller limit is worth looking for
constexpr std::uint32_t kBlockPoints = 64;
constexpr float kPlane = 0.5f;  // confidence
constexpr float kResiduals = 3;
constexpr float kOff = 0.12f;  // of the way

/// The limits of one block after another.
class Limiter {
 public:
  Limiter(const CellGrid& grid, float slope, const std::vector<float>& radii,
          const std::vector<float>& smallest, const OwnSheets* own)
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

  /// min_j (R_j + distance / 2).
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

  /// Does j lie on the plane of i, as far as one can tell?
  [[nodiscard]] bool on_plane(std::uint32_t i, std::uint32_t j, float distance) const {
    if (!own_ || own_->confidences[i] < kPlane) return false;
    const float off = std::abs(own_->normals[i].dot(grid_.points()[j] - grid_.points()[i]));
    return off <= std::max(kResiduals * own_->residuals[i], kOff * distance);
  }

  const CellGrid& grid_;
  float slope_;  // of R over distance
  const std::vector<float>& radii_;
  const std::vector<float>& smallest_;
  const OwnSheets* own_;
  std::vector<Leaf> leaves_;
};

}  // namespace

void limit_growth(const CellGrid& grid, float slope, std::vector<float>& radii,
                  const OwnSheets* own) {
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
