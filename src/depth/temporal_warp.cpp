#include "depth/temporal_warp.hpp"

#include <algorithm>
#include <cmath>

#include "depth/temporal_limits.hpp"

namespace palpate::depth {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kReach = 0.75F;     // blocks from a piece's middle to the blocks it is offered to
constexpr float kInflation = 0.1F;  // share of the mean's variance that each move adds
constexpr float kGrazing = 0.02F;   // n.ray / |ray|: planes seen closer to edge-on are given up

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

}  // namespace

void TemporalWarp::resize(std::size_t blocks) {
  claims_.resize(blocks);
  warped_.resize(blocks);
}

void TemporalWarp::offer(const Claim& claim, std::size_t block) {
  Claim& held = claims_[block];
  if (held.from >= 0) {
    const float limit = another_surface(held.rho);
    const bool hidden = claim.rho < held.rho - limit;
    const bool hides = claim.rho > held.rho + limit;
    if (hidden || (!hides && claim.offset2 >= held.offset2)) return;
  }
  held = claim;
}

void TemporalWarp::claim(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
                         const std::vector<BlockMemory>& memory) {
  std::fill(claims_.begin(), claims_.end(), Claim{});
  const Move move(T_now_before);
  const auto per_x = static_cast<float>(1 / grid.step_x);
  const auto per_y = static_cast<float>(1 / grid.step_y);
  const auto x0 = static_cast<float>(grid.x0);
  const auto y0 = static_cast<float>(grid.y0);
  for (int row = 0; row < grid.rows; ++row) {
    const auto y = static_cast<float>(grid.y(row));
    for (int column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      const BlockMemory& m = memory[i];
      if (m.count == 0) continue;
      const Vector3f p = move.point(Vector3f(static_cast<float>(grid.x(column)), y, 1) / m.rho);
      if (!(p.z() > 0)) continue;
      const float rho = 1 / p.z();
      const float c = (p.x() * rho - x0) * per_x;
      const float r = (p.y() * rho - y0) * per_y;
      if (!(c > -1 && r > -1 && c < static_cast<float>(grid.columns) &&
            r < static_cast<float>(grid.rows))) {
        continue;
      }
      const int last_column = std::min(grid.columns - 1, static_cast<int>(std::floor(c + kReach)));
      const int last_row = std::min(grid.rows - 1, static_cast<int>(std::floor(r + kReach)));
      for (int b = std::max(0, static_cast<int>(std::ceil(r - kReach))); b <= last_row; ++b) {
        for (int a = std::max(0, static_cast<int>(std::ceil(c - kReach))); a <= last_column; ++a) {
          const float dc = c - static_cast<float>(a);
          const float dr = r - static_cast<float>(b);
          offer({static_cast<std::int32_t>(i), rho, dc * dc + dr * dr}, grid.index(a, b));
        }
      }
    }
  }
}

void TemporalWarp::warp(const BlockGrid& grid, const Eigen::Isometry3d& T_now_before,
                        std::vector<BlockMemory>& memory, std::vector<float>& expected) {
  claim(grid, T_now_before, memory);
  const Move move(T_now_before);
  const auto step2 = static_cast<float>(grid.step_x * grid.step_y);
  std::size_t i = 0;
  for (int row = 0; row < grid.rows; ++row) {
    const auto y = static_cast<float>(grid.y(row));
    for (int column = 0; column < grid.columns; ++column, ++i) {
      const auto x = static_cast<float>(grid.x(column));
      const BlockMemory& own = memory[i];
      expected[i] = own.count > 0 ? seen_at(move.plane(plane_of(own, x, y)), x, y) : 0.0F;
      BlockMemory& to = warped_[i];
      to = {};
      const Claim& claim = claims_[i];
      if (claim.from < 0) continue;
      const BlockMemory& from = memory[static_cast<std::size_t>(claim.from)];
      const auto from_x = static_cast<float>(grid.x(claim.from % grid.columns));
      const auto from_y = static_cast<float>(grid.y(claim.from / grid.columns));
      const Vector3f plane = move.plane(plane_of(from, from_x, from_y));
      const float rho = seen_at(plane, x, y);
      if (!(rho > 0) || std::abs(rho - claim.rho) > another_surface(rho)) continue;
      to = from;
      to.rho = rho;
      to.slope_x = plane.x();
      to.slope_y = plane.y();
      const float mean = 1 / static_cast<float>(from.count);
      to.extra += mean * (kInflation * from.variance + from.slope_variance * claim.offset2 * step2);
    }
  }
  memory.swap(warped_);
}

}  // namespace palpate::depth
