// The dual active set method: from the wanted motion, which no constraint holds yet, to the allowed
// one; each iteration adds a violated constraint or drops one that would have to pull.
#include "tool/active_set.hpp"

#include <algorithm>
#include <limits>

namespace palpate {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();  // no step length at all
// A share of a normal's length: one that stands out of the span of others by less lies in it. There
// the rounding of a bound, some 1e-16 m, comes to move a tool by 0.1 nm.
constexpr double kDependent = 1e-6;
constexpr double kNoShare = 1e-14;  // of a multiplier: rounding

using Coordinates = std::array<double, kFreedoms>;

// The active constraints, their normals as orthonormal directions times a triangle.
class ActiveSet {
 public:
  ActiveSet(std::span<const Constraint> constraints, int iterations, LeastMotion& answer) noexcept
      : constraints_(constraints), iterations_(iterations), answer_(answer) {}

  // Makes the constraint hold with the least motion. False: the active ones contradict it.
  [[nodiscard]] bool add(int index) noexcept {
    const Constraint& added = constraints_[static_cast<std::size_t>(index)];
    double multiplier = 0;
    while (++answer_.iterations <= iterations_) {
      const Split split = split_off(added.normal);
      const double lacking = added.bound - added.normal.dot(answer_.motion);
      const double whole =
          split.independent ? std::max(0.0, lacking) / split.rest.squaredNorm() : kNever;
      const Drop first = first_to_pull(split.share);
      const double step = std::min(whole, first.step);
      if (step == kNever) return false;
      if (split.independent) answer_.motion += step * split.rest;
      for (int k = 0; k < answer_.count; ++k) {
        double& held = active(k).multiplier;
        held = std::max(0.0, held - step * split.share[static_cast<std::size_t>(k)]);
      }
      multiplier += step;
      if (whole <= first.step) {
        append(index, multiplier, split);
        return true;
      }
      remove(first.active);
    }
    return true;
  }

 private:
  // A normal as shares of the active ones, and what stands out of their span.
  struct Split {
    Coordinates along{};  // the directions
    Coordinates share{};  // of the active normals
    Motion rest;
    bool independent = false;
  };
  // The active constraint whose multiplier comes to zero first, and after which step.
  struct Drop {
    int active = -1;
    double step = kNever;
  };

  [[nodiscard]] ActiveConstraint& active(int k) noexcept {
    return answer_.active[static_cast<std::size_t>(k)];
  }

  [[nodiscard]] Split split_off(const Motion& normal) const noexcept {
    Split split;
    split.rest = normal;
    for (int pass = 0; pass < 2; ++pass) {  // the second takes what rounding left
      for (int k = 0; k < answer_.count; ++k) {
        const double part = directions_.col(k).dot(split.rest);
        split.along[static_cast<std::size_t>(k)] += part;
        split.rest -= part * directions_.col(k);
      }
    }
    for (int k = answer_.count - 1; k >= 0; --k) {
      double left = split.along[static_cast<std::size_t>(k)];
      for (int j = k + 1; j < answer_.count; ++j) {
        left -= triangle_(k, j) * split.share[static_cast<std::size_t>(j)];
      }
      split.share[static_cast<std::size_t>(k)] = left / triangle_(k, k);
    }
    split.independent = answer_.count < kFreedoms && split.rest.norm() > kDependent * normal.norm();
    return split;
  }

  [[nodiscard]] Drop first_to_pull(const Coordinates& share) noexcept {
    Drop first;
    for (int k = 0; k < answer_.count; ++k) {
      if (!(share[static_cast<std::size_t>(k)] > kNoShare)) continue;
      const double step = active(k).multiplier / share[static_cast<std::size_t>(k)];
      if (step < first.step) first = {k, step};
    }
    return first;
  }

  void append(int index, double multiplier, const Split& split) noexcept {
    const int k = answer_.count++;
    active(k) = {index, multiplier};
    const double length = split.rest.norm();
    directions_.col(k) = split.rest / length;
    for (int j = 0; j < k; ++j) triangle_(j, k) = split.along[static_cast<std::size_t>(j)];
    triangle_(k, k) = length;
  }

  void remove(int dropped) noexcept {
    const int before = answer_.count;
    answer_.count = dropped;  // those before it keep their directions
    for (int k = dropped + 1; k < before; ++k) {
      const ActiveConstraint kept = active(k);
      append(kept.index, kept.multiplier,
             split_off(constraints_[static_cast<std::size_t>(kept.index)].normal));
    }
  }

  std::span<const Constraint> constraints_;
  int iterations_;
  LeastMotion& answer_;
  Eigen::Matrix<double, kFreedoms, kFreedoms> directions_ =
      Eigen::Matrix<double, kFreedoms, kFreedoms>::Zero();
  Eigen::Matrix<double, kFreedoms, kFreedoms> triangle_ =
      Eigen::Matrix<double, kFreedoms, kFreedoms>::Zero();
};

int most_violated(std::span<const Constraint> constraints, const Motion& motion,
                  double tolerance) noexcept {
  int worst = -1;
  double least = -tolerance;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const double slack = constraints[i].normal.dot(motion) - constraints[i].bound;
    if (slack < least) {
      least = slack;
      worst = static_cast<int>(i);
    }
  }
  return worst;
}

// The share of a motion, from none, that no constraint forbids: none where that is forbidden.
double allowed_share(std::span<const Constraint> constraints, const Motion& motion) noexcept {
  double share = 1;
  for (const Constraint& each : constraints) {
    const double along = each.normal.dot(motion);
    if (along < each.bound) share = along < 0 ? std::min(share, each.bound / along) : 0;
  }
  return std::max(0.0, share);
}

}  // namespace

LeastMotion least_motion(std::span<const Constraint> constraints, const Motion& wanted,
                         double tolerance, int iterations) noexcept {
  LeastMotion answer;
  answer.motion = wanted;
  ActiveSet set(constraints, iterations, answer);
  while (answer.iterations < iterations) {
    const int worst = most_violated(constraints, answer.motion, tolerance);
    if (worst < 0) return answer;
    if (!set.add(worst)) {
      answer.end = LeastMotion::End::infeasible;
      return answer;
    }
  }
  answer.end = LeastMotion::End::cut_off;
  answer.motion *= allowed_share(constraints, answer.motion);
  return answer;
}

}  // namespace palpate
