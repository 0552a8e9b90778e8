// Scores what a hand felt of an event, tick by tick against the truth.

#include <algorithm>
#include <cmath>
#include <limits>

#include "events/event.hpp"

namespace palpate::events {
namespace {

using Eigen::Vector3d;

constexpr double kInside = 0.008;  // m; judgement: deeper than noise and lag explain
constexpr double kHeld = 0.2;      // of the force that there should be; judgement: as in table A
constexpr std::size_t kMeanTicks = 50;  // derived: 50 ms, a period of 20 Hz

double depth_of(const Event& event, std::size_t tick, const Vector3d& x) {
  const double t = static_cast<double>(tick) * kTick;
  return -distance_and_normal(event.scene, x, t).value;
}

double rms_of(const Event& event, const Felt& felt) {
  double squares = 0;
  double count = 0;
  for (std::size_t i = event.begin + kMeanTicks; i < felt.force.size(); ++i) {
    Vector3d mean = Vector3d::Zero();
    for (std::size_t k = 0; k < kMeanTicks; ++k) mean += felt.force[i - k] / kMeanTicks;
    squares += (felt.force[i - kMeanTicks / 2] - mean).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

constexpr bench::Column<Score> kColumns[] = {{"step N", &Score::step, 2},
                                             {"most N", &Score::most, 1},
                                             {"least", &Score::least, 2, 1, false},
                                             {"last", &Score::last, 2, 1, false},
                                             {"lost", &Score::lost, 3},
                                             {"behind s", &Score::behind, 2},
                                             {"beyond mm", &Score::beyond, 1},
                                             {"rms N", &Score::rms, 3}};

}  // namespace

Score score(const Event& event, const Felt& felt) {
  Score out;
  double lost = 0;
  double held = 0;
  for (std::size_t i = event.begin; i < felt.force.size(); ++i) {
    if (i > 0) out.step = std::max(out.step, (felt.force[i] - felt.force[i - 1]).norm());
    const double force = felt.force[i].norm();
    if (!std::isfinite(force)) out.step = std::numeric_limits<double>::infinity();
    out.most = std::max(out.most, force);
    const double inside = depth_of(event, i, felt.proxy[i]);
    if (inside > kInside) out.behind += kTick;
    if (felt.touching[i]) out.beyond = std::max(out.beyond, -1e3 * inside);
    const bool deep = !event.when_deep || depth_of(event, i, event.hip[i]) > 0.99 * event.depth;
    if (event.depth <= 0 || !deep) continue;
    ++held;
    out.last = force / (kK * event.depth);
    out.least = std::min(out.least, out.last);
    if (out.last < kHeld) ++lost;
  }
  out.lost = held > 0 ? lost / held : 0;
  out.rms = rms_of(event, felt);
  return out;
}

std::span<const bench::Column<Score>> columns() {
  return kColumns;
}

}  // namespace palpate::events
