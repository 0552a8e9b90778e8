// Compares what a proxy did on a cloud with the truth and with the ideal proxy.
#include "any_cloud/score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/base/error.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kFelt = 0.05;        // N
constexpr double kFeltSurely = 0.1;   // N
constexpr double kAgainst = -0.5;     // cosine
constexpr double kLostShare = 0.2;    // a smaller share of the force wanted is contact lost
constexpr int kThroughTicks = 3;      // lost for so long, a hand is through
constexpr double kIdealError = 0.05;  // s
constexpr double kInside = 1;         // s: what edges round off is no way through

double mean(double sum, double count) {
  return count > 0 ? sum / count : kNone;
}

double quantile(std::vector<double> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

double largest_step(const HostileScene& scene, const Trace& trace) {
  double largest = 0;
  for (std::size_t i = 1; i < scene.ticks.size(); ++i) {
    const HandTick& now = scene.ticks[i];
    const HandTick& before = scene.ticks[i - 1];
    if (now.wanted == Wanted::ignored || before.wanted == Wanted::ignored) continue;
    const double step = (trace.force[i] - trace.force[i - 1]).norm();
    largest = std::max(largest, step - scene.stiffness * (now.hand - before.hand).norm());
  }
  return largest;
}

// The energy of the stroke that gives the hand most.
double most_energy(const HostileScene& scene, const Trace& trace) {
  double most = 0;
  double given = 0;
  for (std::size_t i = 1; i < scene.ticks.size(); ++i) {
    const Vector3d way = (scene.ticks[i].hand - scene.ticks[i - 1].hand) / scene.spacing;
    given =
        scene.ticks[i].starts ? 0 : given + 0.5 * (trace.force[i] + trace.force[i - 1]).dot(way);
    const bool ends = i + 1 == scene.ticks.size() || scene.ticks[i + 1].starts;
    if (ends) most = std::max(most, given);
  }
  return most;
}

// What became of pokes: strokes, and the parts of one that never lets go of its hand.
class Pokes {
 public:
  /// `noise`: of the points, s.
  Pokes(const HostileScene& scene, const Trace& trace, const Trace& ideal, double noise)
      : scene_(scene), trace_(trace), ideal_(ideal), noise_(noise) {}

  void add(std::size_t i) {
    const HandTick& tick = scene_.ticks[i];
    if (tick.starts || tick.poke) end();
    if (tick.wanted == Wanted::ignored || tick.wanted == Wanted::either) return;
    const double felt = trace_.force[i].norm();
    const double wanted = ideal_.force[i].norm();
    ++ticks_;
    if (felt > kMostOver * wanted + kNewtonsPerSpacing * (kRough + 3 * noise_)) ++over_;
    if (wanted >= kNewtonsPerSpacing * scene_.deep) {
      required_ = true;
      const bool inside = true_distance(scene_, trace_.proxy[i]) < -kInside;
      lost_run_ = felt >= kLostShare * wanted || !inside ? 0 : lost_run_ + 1;
      passed_ = passed_ || lost_run_ == kThroughTicks;
    }
    if (wanted > 0 || felt <= kFelt || true_distance(scene_, tick.hand) < kOutside) return;
    if (true_distance(scene_, trace_.proxy[i]) > kAtBody) return;
    held_ = true;
    most_ = std::max(most_, felt);
  }

  void tell(Score& score) {
    end();
    score.pokes = asked_;
    score.passed = through_;
    score.held = outside_;
    score.most_outside = most_;
    score.over = 100 * mean(over_, ticks_);
  }

 private:
  static constexpr double kOutside = 8;     // s
  static constexpr double kAtBody = 4;      // s; a proxy farther out touches outliers, not the body
  static constexpr double kMostOver = 1.3;  // times the force wanted
  static constexpr double kRough = 0.5;     // s: what a surface of points may be off its solid

  void end() {
    if (required_) ++asked_;
    if (passed_) ++through_;
    if (held_) ++outside_;
    required_ = passed_ = held_ = false;
    lost_run_ = 0;
  }

  const HostileScene& scene_;
  const Trace& trace_;
  const Trace& ideal_;
  double noise_;
  double asked_ = 0;
  double through_ = 0;
  double outside_ = 0;
  double most_ = 0;
  double over_ = 0;
  double ticks_ = 0;
  bool required_ = false;
  bool passed_ = false;
  bool held_ = false;
  int lost_run_ = 0;
};

// What is compared tick by tick with the ideal.
class Comparison {
 public:
  Comparison(const HostileScene& scene, const Trace& trace, const Trace& ideal)
      : scene_(scene), trace_(trace), ideal_(ideal) {}

  void add(std::size_t i) {
    const HandTick& tick = scene_.ticks[i];
    const double felt = trace_.force[i].norm();
    if (tick.starts) lost_run_ = 0;
    if (tick.wanted == Wanted::free && felt > kFelt) ++in_free_air_;
    if (tick.wanted == Wanted::ignored || !scene_.truth) return;
    if (felt > 0) add_height(std::abs(true_distance(scene_, trace_.proxy[i])));
    if (tick.wanted != Wanted::judged) return;
    if (is_within(i)) ++within_;
    const double wanted = ideal_.force[i].norm();
    const double away = true_distance(scene_, tick.hand);
    if (away > scene_.clear && felt > kFelt && way_is_free(trace_, i)) ++caught_;
    if (away > scene_.clear && wanted == 0 && felt > kFelt) ++in_free_air_;
    if (wanted > 0) squares_ += (trace_.force[i] - ideal_.force[i]).squaredNorm();
    if (wanted > 0) ++touching_;
    if (wanted >= kNewtonsPerSpacing * scene_.deep) add_required(felt / wanted);
    const double along = trace_.force[i].dot(ideal_.force[i]);
    if (std::min(felt, wanted) > kFeltSurely && along < kAgainst * felt * wanted) ++wrong_;
    check_ideal(i, away);
  }

  void tell(Score& score) const {
    score.force_error = std::sqrt(mean(squares_, touching_));
    score.force_ratio = mean(ratios_, required_);
    score.lost = 100 * mean(lost_, required_);
    score.through = through_;
    score.in_free_air = in_free_air_;
    score.wrong_side = wrong_;
    score.height = mean(heights_, felt_);
    score.highest = felt_ > 0 ? highest_ : kNone;
    score.ideal_off = ideal_off_;
    score.within = within_;
    score.caught = caught_;
  }

 private:
  void add_required(double ratio) {
    ++required_;
    ratios_ += ratio;
    const bool lost = !(ratio >= kLostShare);
    lost_run_ = lost ? lost_run_ + 1 : 0;
    if (lost) ++lost_;
    if (lost_run_ == kThroughTicks) ++through_;
  }

  void add_height(double height) {
    ++felt_;
    heights_ += height;
    highest_ = std::max(highest_, height);
  }

  void check_ideal(std::size_t i, double away) {
    const double wanted = ideal_.force[i].norm();
    const double height = true_distance(scene_, ideal_.proxy[i]);
    const bool missing = away < -scene_.deep && wanted < kFelt;
    const bool apart = height < -kIdealError || (wanted > 0 && height > kIdealError);
    const bool stuck = wanted > kFelt && away > scene_.clear && way_is_free(ideal_, i);
    if (missing || apart || stuck) ++ideal_off_;
  }

  // Has the proxy passed the true surface, or does that hold it from the other side?
  [[nodiscard]] bool is_within(std::size_t i) const {
    const Distance at = true_surface(scene_, trace_.proxy[i]);
    const Vector3d force = scene_.T_world_draft.linear().transpose() * trace_.force[i];
    return at.value < -kInside ||
           at.gradient.dot(force) < kAgainst * at.gradient.norm() * force.norm();
  }

  // From the proxy straight to the hand.
  [[nodiscard]] bool way_is_free(const Trace& trace, std::size_t i) const {
    constexpr int kPlaces = 400;  // thin panels lie between
    const Vector3d from = trace.proxy[i];
    for (int k = 1; k < kPlaces; ++k) {
      const double share = static_cast<double>(k) / kPlaces;
      if (true_distance(scene_, from + share * (scene_.ticks[i].hand - from)) < 0) return false;
    }
    return true;
  }

  const HostileScene& scene_;
  const Trace& trace_;
  const Trace& ideal_;
  double squares_ = 0;
  double touching_ = 0;
  double ratios_ = 0;
  double required_ = 0;
  double lost_ = 0;
  double through_ = 0;
  double in_free_air_ = 0;
  double wrong_ = 0;
  double heights_ = 0;
  double highest_ = 0;
  double felt_ = 0;
  double ideal_off_ = 0;
  double within_ = 0;
  double caught_ = 0;
  int lost_run_ = 0;
};

void count_pokes(const HostileScene& scene, const Rendered& rendered, const Trace& ideal,
                 Score& score) {
  Pokes pokes(scene, rendered.trace, ideal, rendered.report.noise / scene.spacing);
  for (std::size_t i = 0; i < scene.ticks.size(); ++i) pokes.add(i);
  pokes.tell(score);
}

}  // namespace

Score score(const HostileScene& scene, const Rendered& rendered, const Trace& ideal) {
  const Trace& trace = rendered.trace;
  Comparison comparison(scene, trace, ideal);
  for (std::size_t i = 0; i < scene.ticks.size(); ++i) comparison.add(i);
  Score score;
  comparison.tell(score);
  if (scene.truth) count_pokes(scene, rendered, ideal, score);
  score.step = largest_step(scene, trace);
  score.ideal_step = scene.truth ? largest_step(scene, ideal) : kNone;
  score.energy = most_energy(scene, trace);
  score.faults = static_cast<double>(std::count(trace.fault.begin(), trace.fault.end(), true));
  score.usual_us = quantile(trace.microseconds, 0.5);
  score.slow_us = quantile(trace.microseconds, 0.999);
  score.slowest_us = quantile(trace.microseconds, 1);
  score.radius = rendered.report.radius / scene.spacing;
  score.radius_largest = rendered.report.radius_largest / scene.spacing;
  score.noise = rendered.report.noise / scene.spacing;
  return score;
}

std::vector<Result> run_row(const Row& row, std::uint64_t seed, const std::vector<Touch>& ways) {
  const HostileScene scene = make_scene(row, seed);
  const Trace ideal = scene.truth ? touch_truth(scene) : Trace{};
  std::vector<Result> results;
  for (const Touch& way : ways) {
    try {
      results.push_back({row.name, seed, score(scene, way(scene), ideal), {}});
    } catch (const Error& error) {
      results.push_back({row.name, seed, std::nullopt, error.what()});
    }
  }
  return results;
}

Result run_row(const Row& row, std::uint64_t seed, const FieldOptions& field) {
  const Touch way = [&](const HostileScene& scene) { return touch(scene, field); };
  return run_row(row, seed, std::vector{way}).front();
}

}  // namespace palpate::any_cloud
