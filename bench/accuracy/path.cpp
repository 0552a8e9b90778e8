// Builds the path of a hand from lines, curves and pauses.
#include "accuracy/path.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::accuracy {
namespace {

constexpr double kEase = 0.1;  // s, for speeding up and for slowing down; judgement

int ticks(double seconds) {
  return std::max(1, static_cast<int>(std::lround(seconds / kTick)));
}

// Way at time t of a motion of unit length that takes T + kEase: the speed rises and falls as a
// cosine does within kEase, and is 1/T between.
double eased(double t, double T) {
  const auto ramp = [](double s) {
    const double pi = std::acos(-1.0);
    return s <= 0 ? 0 : (s >= 1 ? s - 0.5 : 0.5 * (s - std::sin(pi * s) / pi));
  };
  return kEase / T * (ramp(t / kEase) - ramp((t - T) / kEase));
}

}  // namespace

PathBuilder& PathBuilder::line_to(const Eigen::Vector3d& goal, double speed) {
  const Eigen::Vector3d from = path_.hip.back();
  const int n = ticks((goal - from).norm() / speed);
  for (int i = 1; i <= n; ++i) {
    path_.hip.push_back(from + (goal - from) * (static_cast<double>(i) / n));
  }
  return *this;
}

PathBuilder& PathBuilder::hold(double seconds) {
  path_.hip.insert(path_.hip.end(), static_cast<std::size_t>(ticks(seconds)), path_.hip.back());
  return *this;
}

PathBuilder& PathBuilder::curve(const std::function<Eigen::Vector3d(double)>& curve,
                                double length) {
  const double T = length / kHandSpeed;
  const int n = ticks(T + kEase);
  for (int i = 1; i <= n; ++i) path_.hip.push_back(curve(eased(i * kTick, T)));
  return *this;
}

PathBuilder& PathBuilder::start_score() {
  path_.begin = path_.hip.size();
  return *this;
}

PathBuilder& PathBuilder::end_score() {
  path_.end = path_.hip.size();
  return *this;
}

Path PathBuilder::build() const {
  Path path = path_;
  if (path.end == 0) path.end = path.hip.size();
  return path;
}

}  // namespace palpate::accuracy
