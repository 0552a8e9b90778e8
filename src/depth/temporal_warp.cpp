// Moves remembered planes into the view of a camera that has moved.
#include <algorithm>
#include <cmath>

#include "depth/temporal_filter.hpp"

namespace palpate::depth {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

// Blocks from a piece's middle to those it is offered to (judgement)
constexpr float kWarpReach = 0.75F;
constexpr float kInflation = 0.1F;  // share of the mean's variance that each move adds (judgement)
// Share of another surface's distance, between neighbours (judgement)
constexpr float kContinuous = 0.1F;
// n.ray / |ray|; planes closer to edge-on are dropped (judgement)
constexpr float kGrazing = 0.02F;

/// A plane as the vector a with a.p = 1 for its points p.
Vector3f plane_of(const BlockMemory& m, float x, float y) {
  return {m.slope_x, m.slope_y, m.rho - m.slope_x * x - m.slope_y * y};
}

/// Rotation and translation as floats; how planes and points move.
struct Move {
  Matrix3f rotation;
  Vector3f translation;

  explicit Move(const Eigen::Isometry3d& T)
      : rotation(T.linear().cast<float>()), translation(T.translation().cast<float>()) {}

  [[nodiscard]] Vector3f point(const Vector3f& p) const { return rotation * p + translation; }
  /// a'.p' = 1 for p' = R p + t.
  [[nodiscard]] Vector3f plane(const Vector3f& a) const {
    const Vector3f turned = rotation * a;
    return turned / (1 + turned.dot(translation));
  }
};

/// Inverse depth at which the plane is seen along (x, y, 1); 0: not, or edge-on.
float seen_at(const Vector3f& plane, float x, float y) {
  const float rho = plane.x() * x + plane.y() * y + plane.z();
  const bool clear = rho > kGrazing * plane.norm() * std::sqrt(1 + x * x + y * y);
  return clear ? rho : 0.0F;
}

/// Change of the slopes from block to block; it keeps curved surfaces curved when their pieces are
/// cut beside their middles.
struct Curvature {
  float xx = 0, yy = 0, xy = 0;  // 1/m
};

/// Does a neighbour `dx`, `dy` away continue the piece?
bool continues(const BlockMemory& m, const BlockMemory& neighbor, float dx, float dy) {
  if (neighbor.count == 0 || !(neighbor.confidence > 0)) return false;
  const float jump = neighbor.rho - (m.rho + m.slope_x * dx + m.slope_y * dy);
  return std::abs(jump) < kContinuous * another_surface(m.rho);
}

Curvature curvature_at(const BlockGrid& grid, const std::vector<BlockMemory>& memory, std::size_t i,
                       int column, int row) {
  Curvature curvature;
  if (column < 1 || row < 1 || column + 1 >= grid.columns || row + 1 >= grid.rows) return curvature;
  const BlockMemory& m = memory[i];
  const auto dx = static_cast<float>(grid.step_x);
  const auto dy = static_cast<float>(grid.step_y);
  const BlockMemory* row_of = &memory[i];
  const BlockMemory& left = row_of[-1];
  const BlockMemory& right = row_of[1];
  const BlockMemory& above = row_of[-grid.columns];
  const BlockMemory& below = row_of[grid.columns];
  const bool whole = m.confidence > 0 && continues(m, left, -dx, 0) && continues(m, right, dx, 0) &&
                     continues(m, above, 0, -dy) && continues(m, below, 0, dy);
  if (!whole) return curvature;
  curvature.xx = (right.slope_x - left.slope_x) / (2 * dx);
  curvature.yy = (below.slope_y - above.slope_y) / (2 * dy);
  curvature.xy = 0.5F * ((right.slope_y - left.slope_y) / (2 * dx) +
                         (below.slope_x - above.slope_x) / (2 * dy));
  return curvature;
}

}  // namespace

void TemporalWarp::resize(std::size_t blocks) {
  claims_.resize(blocks);
  planes_.resize(blocks);
  warped_.resize(blocks);
}

void TemporalWarp::offer(const Claim& claim, std::size_t block) {
  Claim& held = claims_[block];
  if (held.from >= 0) {
    const float limit = another_surface(held.rho);
    const bool hidden = claim.rho < held.rho - limit;
    const bool hides = claim.rho > held.rho + limit;
    const bool closer =
        claim.dc * claim.dc + claim.dr * claim.dr < held.dc * held.dc + held.dr * held.dr;
    if (hidden || (!hides && !closer)) return;
  }
  held = claim;
}

// Offers a piece to the blocks next to its middle, at column c and row r.
void TemporalWarp::offer_around(const BlockGrid& grid, std::int32_t from, float rho, float c,
                                float r) {
  const bool inside =
      c > -1 && r > -1 && c < static_cast<float>(grid.columns) && r < static_cast<float>(grid.rows);
  if (!inside) return;
  const int last_column = std::min(grid.columns - 1, static_cast<int>(std::floor(c + kWarpReach)));
  const int last_row = std::min(grid.rows - 1, static_cast<int>(std::floor(r + kWarpReach)));
  for (int b = std::max(0, static_cast<int>(std::ceil(r - kWarpReach))); b <= last_row; ++b) {
    for (int a = std::max(0, static_cast<int>(std::ceil(c - kWarpReach))); a <= last_column; ++a) {
      offer({from, rho, c - static_cast<float>(a), r - static_cast<float>(b)}, grid.index(a, b));
    }
  }
}

void TemporalWarp::claim(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
                         const std::vector<BlockMemory>& memory) {
  std::fill(claims_.begin(), claims_.end(), Claim{});
  const Move move(T_now_before);
  const auto per_x = static_cast<float>(1 / grid.step_x);
  const auto per_y = static_cast<float>(1 / grid.step_y);
  const auto x0 = static_cast<float>(grid.x0);
  const auto y0 = static_cast<float>(grid.y0);
  std::size_t i = 0;
  for (int row = 0; row < grid.rows; ++row) {
    const auto y = static_cast<float>(grid.y(row));
    for (int column = 0; column < grid.columns; ++column, ++i) {
      const BlockMemory& m = memory[i];
      if (m.count == 0) continue;
      const auto x = static_cast<float>(grid.x(column));
      planes_[i] = move.plane(plane_of(m, x, y));
      const Vector3f p = move.point(Vector3f(x, y, 1) / m.rho);
      if (!(p.z() > 0)) continue;
      const float rho = 1 / p.z();
      offer_around(grid, static_cast<std::int32_t>(i), rho, (p.x() * rho - x0) * per_x,
                   (p.y() * rho - y0) * per_y);
    }
  }
}

// The piece that a block is given, where its ray meets it.
bool TemporalWarp::put(const BlockGrid& grid, const std::vector<BlockMemory>& memory,
                       const Claim& claim, float x, float y, BlockMemory& to) const {
  const auto i = static_cast<std::size_t>(claim.from);
  const int column = claim.from % grid.columns;
  const int row = claim.from / grid.columns;
  const BlockMemory& from = memory[i];
  const Vector3f plane = planes_[i];
  const float rho = seen_at(plane, x, y);
  if (!(rho > 0) || std::abs(rho - claim.rho) > another_surface(rho)) return false;
  const Curvature curvature = curvature_at(grid, memory, i, column, row);
  const float dx = -claim.dc * static_cast<float>(grid.step_x);
  const float dy = -claim.dr * static_cast<float>(grid.step_y);
  to = from;
  to.slope_x = plane.x() + curvature.xx * dx + curvature.xy * dy;
  to.slope_y = plane.y() + curvature.xy * dx + curvature.yy * dy;
  to.rho = rho + 0.5F * (curvature.xx * dx * dx + curvature.yy * dy * dy) + curvature.xy * dx * dy;
  to.calm_since += to.rho - from.rho;
  to.last[0] = 0;  // how frames scatter is learned in one view
  to.extra += (kInflation * from.variance + from.slope_variance * (dx * dx + dy * dy)) /
              static_cast<float>(from.count);
  return true;
}

void TemporalWarp::warp(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
                        std::vector<BlockMemory>& memory) {
  claim(grid, T_now_before, memory);
  std::size_t i = 0;
  for (int row = 0; row < grid.rows; ++row) {
    const auto y = static_cast<float>(grid.y(row));
    for (int column = 0; column < grid.columns; ++column, ++i) {
      const auto x = static_cast<float>(grid.x(column));
      const bool given = claims_[i].from >= 0 && put(grid, memory, claims_[i], x, y, warped_[i]);
      if (!given) warped_[i] = {};
    }
  }
  memory.swap(warped_);
}

}  // namespace palpate::depth
