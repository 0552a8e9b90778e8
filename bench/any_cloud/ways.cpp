// Draws the strokes of hands that several families share.
#include "any_cloud/ways.hpp"

#include <Eigen/Geometry>
#include <numbers>

namespace palpate::any_cloud {

using Eigen::Vector3d;

void zig_zag(Draft& draft, double depth, double half) {
  constexpr int kLines = 5;
  constexpr double kAbove = 15;
  const Eigen::AngleAxisd turn(draft.between(0, 2 * std::numbers::pi), Vector3d::UnitZ());
  const Vector3d middle = draft.within({-3, -3, -depth}, {3, 3, -depth});
  const auto at = [&](double x, double y) { return Vector3d(middle + turn * Vector3d(x, y, 0)); };
  const Vector3d up(0, 0, depth + kAbove);
  draft.hand.start(at(-half, -half) + up).to(at(-half, -half), kPush);
  for (int i = 0; i < kLines; ++i) {
    const double x = i % 2 == 0 ? half : -half;
    const double y = -half + 2 * half * i / (kLines - 1);
    draft.hand.to(at(-x, y), kSlide).to(at(x, y), kSlide);
  }
  draft.hand.to(at(half, half) + up, kPush);
}

void push(Draft& draft, const Vector3d& from, const Vector3d& deepest) {
  draft.hand.start(from).to(deepest, kPush).to(from, kPush);
}

}  // namespace palpate::any_cloud
