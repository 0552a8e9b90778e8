// Scores a trace against the ideal one, tick by tick.
#include "accuracy/score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy/high_pass.hpp"
#include "accuracy/ideal_proxy.hpp"

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kNoForce = 1e-6;       // N; judgement: rounding
constexpr double kLostShare = 0.2;      // of the ideal force; judgement: less is not held
constexpr int kPopTicks = 3;            // judgement: a shorter gap is not felt
constexpr double kRippleCutoff = 20;    // Hz; judgement: faster than a hand moves by will
constexpr std::size_t kTrim = 100;      // ticks at either end; derived: two periods of the cut-off
constexpr std::size_t kShortest = 300;  // ticks; derived: three times what is trimmed at one end

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

double ratio(double sum, double count) {
  return count > 0 ? sum / count : 0;
}

}  // namespace

void Scorer::add_tick(const Vector3d& ideal, const Vector3d& rendered) {
  ++ticks_;
  force_squares_ += (rendered - ideal).squaredNorm();
  if (rendered.norm() > kNoForce) {
    const double angle = angle_between(rendered, ideal);
    angle_squares_ += angle * angle;
    ++angles_;
  }
  const bool lost = rendered.norm() < kLostShare * ideal.norm();
  felt_ = felt_ || !lost;
  lost_run_ = lost && felt_ ? lost_run_ + 1 : 0;
  if (lost) ++lost_;
  if (lost_run_ == kPopTicks) ++worst_.pops;
}

void Scorer::add_ripple(const Path& path, const std::vector<Vector3d>& force) {
  const std::size_t n = path.end - path.begin;
  if (n < kShortest) return;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> signal(n);
    for (std::size_t i = 0; i < n; ++i) signal[i] = force[path.begin + i][axis];
    const std::vector<double> fast = high_pass(signal, kRippleCutoff, 1 / kTick);
    for (std::size_t i = kTrim; i + kTrim < n; ++i) ripple_squares_ += fast[i] * fast[i];
  }
  ripples_ += static_cast<double>(n - 2 * kTrim);
}

void Scorer::add_steps(const Path& path, const std::vector<Vector3d>& force) {
  for (std::size_t i = path.begin; i < path.end; ++i) {
    worst_.peak = std::max(worst_.peak, force[i].norm());
    if (i > 0) worst_.step = std::max(worst_.step, (force[i] - force[i - 1]).norm());
  }
  for (std::size_t i = 1; i < path.hip.size(); ++i) {
    worst_.energy += 0.5 * (force[i] + force[i - 1]).dot(path.hip[i] - path.hip[i - 1]);
  }
}

void Scorer::add(const Path& path, const Trace& ideal, const Trace& rendered,
                 const TruthScene& scene) {
  lost_run_ = 0;
  felt_ = false;
  for (std::size_t i = path.begin; i < path.end; ++i) {
    if (ideal.force[i].norm() < kNoForce) continue;
    add_tick(ideal.force[i], rendered.force[i]);
    if (rendered.force[i].norm() < kNoForce) continue;
    height_sum_ += distance_and_normal(scene, rendered.proxy[i]).value;
    ++heights_;
  }
  add_ripple(path, rendered.force);
  add_steps(path, rendered.force);
}

Score Scorer::score() const {
  Score score = worst_;
  score.normal = std::sqrt(ratio(angle_squares_, angles_));
  score.force = std::sqrt(ratio(force_squares_, ticks_));
  score.ripple = std::sqrt(ratio(ripple_squares_, ripples_));
  score.height = 1e3 * ratio(height_sum_, heights_);
  score.lost = ratio(lost_, ticks_);
  return score;
}

Trace ideal_trace(const TruthScene& scene, const Path& path) {
  Trace trace;
  IdealProxy proxy(scene, path.hip.front());
  for (const Vector3d& hip : path.hip) {
    proxy.follow(hip);
    trace.proxy.push_back(proxy.position());
    trace.force.push_back(kStiffness * (proxy.position() - hip));
  }
  return trace;
}

}  // namespace palpate::accuracy
