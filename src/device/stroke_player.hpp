#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "device/explore.hpp"

namespace palpate {

/// Writes rows while moves are appended, until the time is over.
class StrokePlayer {
 public:
  StrokePlayer(const Eigen::Vector3d& origin, const StrokeOptions& options)
      : origin_(origin), options_(options) {}

  [[nodiscard]] bool over() const { return time() > options_.duration; }
  [[nodiscard]] double share() const { return std::min(1.0, time() / options_.duration); }

  void dwell(const Eigen::Vector3d& position, double seconds) {
    const double end = time() + seconds;
    while (time() < end && !over()) add(position);
  }

  void move(const std::vector<Eigen::Vector3d>& path, double speed) {
    std::vector<double> lengths(1, 0.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
      lengths.push_back(lengths.back() + (path[i] - path[i - 1]).norm());
    }
    if (lengths.back() <= 0) return;
    const double seconds = lengths.back() / (speed * (1 - kRamp));
    const double start = time();
    std::size_t k = 1;
    while (time() < start + seconds && !over()) {
      const double done = progress((time() - start) / seconds) * lengths.back();
      while (k + 1 < path.size() && lengths[k] < done) ++k;
      const double length = lengths[k] - lengths[k - 1];
      const double part = length > 0 ? std::clamp((done - lengths[k - 1]) / length, 0.0, 1.0) : 1.0;
      add(path[k - 1] + part * (path[k] - path[k - 1]));
    }
  }

  [[nodiscard]] double time() const { return static_cast<double>(rows_.size()) * options_.period; }
  Trajectory take() { return std::move(rows_); }

 private:
  // of a move: its share spent speeding up, and slowing down (judgement)
  static constexpr double kRamp = 0.2;

  // Share of a move's path that is done after share u of its time: speed rises and falls as a
  // cosine.
  static double progress(double u) {
    const auto ramp = [](double v) {
      return 0.5 * (v - kRamp / std::numbers::pi * std::sin(std::numbers::pi * v / kRamp));
    };
    if (u < kRamp) return ramp(u) / (1 - kRamp);
    if (u > 1 - kRamp) return 1 - ramp(1 - u) / (1 - kRamp);
    return (u - kRamp / 2) / (1 - kRamp);
  }

  void add(const Eigen::Vector3d& position) { rows_.push_back({time(), origin_ + position}); }

  Eigen::Vector3d origin_;
  StrokeOptions options_;
  Trajectory rows_;
};

}  // namespace palpate
