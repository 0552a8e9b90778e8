// Cuts the cell of a point out of a square, by one line for each neighbour. Corners that are left
// are the middles of empty discs.

#include "refine/holes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "geometry/neighborhoods.hpp"

namespace palpate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Points up to a quarter farther from a disc's middle than its rim lie around it; judgement.
constexpr float kDiscRim = 1.25f;  // radii of the disc
// Points; where more are in reach of a hole, nothing is sparse; judgement, for time.
constexpr std::size_t kMostNear = 1 << 14;

// 150 degrees: a wider angle without any is open; judgement.
constexpr float kOpenAngle = 2.6f;  // rad

}  // namespace

HoleFinder::HoleFinder() {
  for (int k = 0; k < kDirections; ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / kDirections;
    cosines_[k] = std::cos(angle);
    sines_[k] = std::sin(angle);
  }
}

void HoleFinder::start(const Vector3f& normal, float reach) {
  u_ = normal.unitOrthogonal();
  v_ = normal.cross(u_);
  cell_.clear();
  for (const Vector2f& corner :
       {Vector2f(1, 1), Vector2f(-1, 1), Vector2f(-1, -1), Vector2f(1, -1)})
    cell_.emplace_back(reach * corner);
  squared_ = 2 * reach * reach;
}

void HoleFinder::cut(const CellGrid& grid, std::uint32_t i, std::span<const std::uint32_t> near) {
  others_.clear();
  for (const std::uint32_t j : near) {
    const Vector3f offset = grid.points()[j] - grid.points()[i];
    const Vector2f along(u_.dot(offset), v_.dot(offset));
    const float squared = along.squaredNorm();
    if (offset.squaredNorm() > 2 * squared) continue;
    others_.push_back(along);
    if (squared > 0 && squared < 4 * squared_) cut(along, 0.5f * squared);
  }
}

void HoleFinder::cut(const Vector2f& other, float half) {
  const auto beyond = [&](const Vector2f& corner) { return other.dot(corner) - half; };
  if (std::ranges::none_of(cell_, [&](const Vector2f& corner) { return beyond(corner) > 0; })) {
    return;
  }
  kept_.clear();
  squared_ = 0;
  const auto keep = [&](const Vector2f& corner) {
    kept_.push_back(corner);
    squared_ = std::max(squared_, corner.squaredNorm());
  };
  Vector2f here = cell_.back();
  float at_here = beyond(here);
  for (const Vector2f& next : cell_) {
    const float at_next = beyond(next);
    if ((at_here <= 0) != (at_next <= 0)) {
      keep(here + at_here / (at_here - at_next) * (next - here));
    }
    if (at_next <= 0) keep(next);
    here = next;
    at_here = at_next;
  }
  std::swap(kept_, cell_);
}

bool HoleFinder::is_filled(const CellGrid& grid, std::uint32_t i,
                           std::span<const std::uint32_t> near, float radius) const {
  constexpr std::size_t kTogether =
      8;  // points between two looks at the result; judgement, for time
  Directions nearest = Directions::Constant(-1);  // how much nearer another is, m^2; below 0: none
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Vector3f offset = grid.points()[near[k]] - grid.points()[i];
    const float x = u_.dot(offset);
    const float y = v_.dot(offset);
    const float squared = x * x + y * y;
    if (offset.squaredNorm() > 2 * squared) continue;
    const Directions ahead = 2 * radius * (x * cosines_ + y * sines_);
    nearest = nearest.max(ahead - squared);
    if (k % kTogether == 0 && nearest.minCoeff() > 0) return true;
  }
  return nearest.minCoeff() > 0;
}

float HoleFinder::radius_beside(const CellGrid& grid, std::uint32_t i,
                                std::span<const std::uint32_t> near,
                                std::span<const std::uint32_t> around, const Vector3f& normal,
                                float least, float largest) {
  start(normal, 2 * largest);
  if (is_filled(grid, i, near, least)) return 0;
  near_.clear();
  std::ranges::copy_if(around, std::back_inserter(near_), [&](std::uint32_t j) {
    return detail::squared_distance(grid.points()[i], grid.points()[j]) <= 4 * least * least;
  });
  if (is_filled(grid, i, near_, least)) return 0;
  cut(grid, i, near_);
  if (squared_ <= least * least) return 0;
  near_.clear();
  grid.within(grid.points()[i], (1 + kDiscRim) * largest, near_);
  if (near_.size() > kMostNear) return 0;
  cut(grid, i, near_);
  float widest = 0;
  for (const Vector2f& corner : cell_) {
    const float radius = corner.norm();
    if (radius > std::max(least, widest) && radius <= largest && is_surrounded(corner)) {
      widest = radius;
    }
  }
  return widest;
}

bool HoleFinder::is_surrounded(const Vector2f& middle) {
  angles_.assign(1, std::atan2(-middle.y(), -middle.x()));
  for (const Vector2f& other : others_) {
    const Vector2f offset = other - middle;
    if (offset.squaredNorm() > kDiscRim * kDiscRim * middle.squaredNorm()) continue;
    angles_.push_back(std::atan2(offset.y(), offset.x()));
  }
  std::ranges::sort(angles_);
  float gap = angles_.front() - angles_.back() + 2 * std::numbers::pi_v<float>;
  for (std::size_t k = 1; k < angles_.size(); ++k) {
    gap = std::max(gap, angles_[k] - angles_[k - 1]);
  }
  return gap < kOpenAngle;
}

}  // namespace palpate
