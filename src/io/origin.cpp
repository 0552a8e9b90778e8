#include "io/origin.hpp"

#include <algorithm>
#include <vector>

namespace palpate::io {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

Eigen::Vector3d choose_origin(std::size_t count,
                              const std::function<Eigen::Vector3d(std::size_t)>& point_at) {
  constexpr std::size_t kSample = 1000;
  constexpr double kFarAway = 16;     // times the spread: four bits
  constexpr double kTiniest = 1e-12;  // m; nothing is measured in less
  std::vector<Eigen::Vector3d> sample;
  for (std::size_t i = 0; i < count; i += count / kSample + 1) {
    const Eigen::Vector3d point = point_at(i);
    if (is_usable(point)) sample.push_back(point);
  }
  if (sample.empty()) return Eigen::Vector3d::Zero();

  Eigen::Vector3d center;
  double spread = 0;
  std::vector<double> values(sample.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(sample.begin(), sample.end(), values.begin(),
                   [&](const Eigen::Vector3d& p) { return p[axis]; });
    center[axis] = median(values);
    for (double& v : values) v = std::abs(v - center[axis]);
    spread = std::max(spread, median(values));
  }
  const double distance = center.cwiseAbs().maxCoeff();
  if (distance <= std::max(kFarAway * spread, kTiniest)) return Eigen::Vector3d::Zero();
  // A single point, or copies of it, has no spread.
  const double size = std::max(spread, 1e-9 * distance);
  const double step = std::pow(10.0, std::ceil(std::log10(size)));
  return ((center / step).array().round() * step).matrix();
}

}  // namespace palpate::io
