// Measures steps, vibration and errors of a run.
#include "streams/stream_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "accuracy/high_pass.hpp"

namespace palpate::streams {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kTrim = 100;     // ticks at either end that filters need
constexpr std::size_t kAfterSwap = 4;  // ticks
constexpr double kLostShare = 0.2;     // a smaller share of the force wanted is contact lost
constexpr int kPopTicks = 3;           // lost for so long is a pop
constexpr double kMillimetres = 1e3;   // in a metre
constexpr double kDegrees = 180 / std::numbers::pi;  // in a radian

struct Moments {
  double sum = 0;
  double squares = 0;
  double count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
  [[nodiscard]] double rms() const { return count > 0 ? std::sqrt(squares / count) : 0; }
  [[nodiscard]] double deviation() const {
    return count > 0 ? std::sqrt(std::max(0.0, squares / count - mean() * mean())) : 0;
  }
};

void add_swaps(const Setup& setup, const StreamTrace& trace, const accuracy::Trace* ideal,
               Measures& out) {
  std::vector<double> jumps;
  Moments moments;
  const auto& force = trace.felt.force;
  for (const std::size_t swap : trace.swaps) {
    if (swap <= setup.path.begin || swap + kAfterSwap > setup.path.end) continue;
    const std::size_t before = swap - 1;
    const std::size_t after = before + kAfterSwap;
    Vector3d change = force[after] - force[before];
    if (ideal) change -= ideal->force[after] - ideal->force[before];
    jumps.push_back(change.norm());
    moments.add(change.norm());
  }
  out.jump = moments.rms();
  if (jumps.empty()) return;
  std::sort(jumps.begin(), jumps.end());
  out.jump_high = jumps[static_cast<std::size_t>(0.95 * static_cast<double>(jumps.size() - 1))];
}

void add_bands(const Setup& setup, const std::vector<Vector3d>& force, Measures& out) {
  const std::size_t n = setup.path.end - setup.path.begin;
  if (n < 3 * kTrim) return;
  double ripple = 0;
  double vibration = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> signal(n);
    for (std::size_t i = 0; i < n; ++i) signal[i] = force[setup.path.begin + i][axis];
    const std::vector<double> fast = accuracy::high_pass(signal, 20, 1 / kTick);
    const std::vector<double> band = accuracy::low_pass(fast, 400, 1 / kTick);
    for (std::size_t i = kTrim; i + kTrim < n; ++i) {
      ripple += fast[i] * fast[i];
      vibration += band[i] * band[i];
    }
  }
  const auto count = static_cast<double>(n - 2 * kTrim);
  out.ripple = std::sqrt(ripple / count);
  out.vibration = std::sqrt(vibration / count);
}

// How far the proxy is under the true surface, m.
double sunk(const Setup& setup, const StreamTrace& trace, std::size_t tick) {
  const double t = static_cast<double>(tick) * kTick;
  return -distance_and_normal(setup.scene, trace.felt.proxy[tick], t).value;
}

// The same before the surface moves: a metaball stands in front of its points.
double sunk_at_rest(const Setup& setup, const StreamTrace& trace) {
  Moments sum;
  for (std::size_t i = setup.rest - kTrim; i < setup.rest; ++i) sum.add(sunk(setup, trace, i));
  return sum.mean();
}

void add_heights(const Setup& setup, const StreamTrace& trace, Measures& out) {
  Moments lag;
  Moments radius;
  std::array<Moments, 3> normal;
  for (std::size_t i = setup.path.begin; i < setup.path.end; ++i) {
    lag.add(sunk(setup, trace, i));
    radius.add(trace.radius[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      normal[axis].add(trace.normal[i][static_cast<Eigen::Index>(axis)]);
    }
  }
  double variance = 0;  // of two tangential directions; along the normal there is next to none
  for (const Moments& axis : normal) variance += axis.deviation() * axis.deviation();
  out.normal_sd = kDegrees * std::sqrt(variance / 2);
  out.radius = kMillimetres * radius.mean();
  out.lag = kMillimetres * lag.mean();
  if (setup.speed > 0) {
    out.lag -= kMillimetres * (setup.speed * setup.latency + sunk_at_rest(setup, trace));
  }
  out.lag_sd = kMillimetres * lag.deviation();
}

void add_contact(const Setup& setup, const StreamTrace& trace, const accuracy::Trace* ideal,
                 Measures& out) {
  const auto& force = trace.felt.force;
  Moments error;
  Moments angle;
  Moments held;
  int lost = 0;
  for (std::size_t i = setup.path.begin; i < setup.path.end; ++i) {
    const double wanted = ideal ? ideal->force[i].norm() : accuracy::kStiffness * setup.depth;
    if (wanted < 1e-6) continue;
    const bool here = force[i].norm() >= kLostShare * wanted;
    held.add(here ? 1 : 0);
    lost = here ? 0 : lost + 1;
    if (lost == kPopTicks) ++out.pops;
    if (i > setup.path.begin) out.step = std::max(out.step, (force[i] - force[i - 1]).norm());
    if (!ideal) continue;
    error.add((force[i] - ideal->force[i]).norm());
    const Vector3d across = force[i].cross(ideal->force[i]);
    angle.add(kDegrees * std::atan2(across.norm(), force[i].dot(ideal->force[i])));
  }
  out.contact = held.mean();
  out.force = error.rms();
  out.normal = angle.rms();
}

}  // namespace

Measures measure(const Setup& setup, const StreamTrace& trace, const accuracy::Trace* ideal) {
  Measures out;
  add_swaps(setup, trace, ideal, out);
  add_bands(setup, trace.felt.force, out);
  add_heights(setup, trace, out);
  add_contact(setup, trace, ideal, out);
  return out;
}

}  // namespace palpate::streams
