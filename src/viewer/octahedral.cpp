#include "viewer/octahedral.hpp"

#include <cmath>

namespace palpate::viewer {
namespace {

std::int8_t rounded(float x) noexcept {
  return static_cast<std::int8_t>(std::lround(127 * x));
}

}  // namespace

std::array<std::int8_t, 2> octahedral(const Eigen::Vector3f& normal) noexcept {
  const float length = normal.lpNorm<1>();
  if (!(length > 0) || !std::isfinite(length)) return {0, 0};
  const Eigen::Vector3f p = normal / length;
  if (p.z() >= 0) return {rounded(p.x()), rounded(p.y())};
  return {rounded(std::copysign(1 - std::abs(p.y()), p.x())),
          rounded(std::copysign(1 - std::abs(p.x()), p.y()))};
}

}  // namespace palpate::viewer
