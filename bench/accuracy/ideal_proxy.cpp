// Moves the ideal god-object on exact solids.
#include "accuracy/ideal_proxy.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace palpate::accuracy {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 5e-5;    // m; derived: a tick at 5 cm/s
constexpr double kRest = 1e-9;    // m; judgement: a shorter step is rest
constexpr double kSlack = 1e-12;  // m; judgement: rounding of metres
constexpr int kMostSteps = 4000;  // derived: 20 cm in steps of 0.05 mm

// The half-space normal . x >= offset, relative to the proxy.
struct Constraint {
  Vector3d normal;
  double offset = 0;
};

bool allowed(std::span<const Constraint> constraints, const Vector3d& x) {
  for (const Constraint& c : constraints) {
    if (c.normal.dot(x) < c.offset - kSlack) return false;
  }
  return true;
}

// The point nearest to `goal` in the planes of the given constraints.
Vector3d onto(const Vector3d& goal, const Constraint& a) {
  return goal + a.normal * (a.offset - a.normal.dot(goal));
}

Vector3d onto(const Vector3d& goal, const Constraint& a, const Constraint& b) {
  const double c = a.normal.dot(b.normal);
  const double det = 1 - c * c;
  if (det < 1e-9) return onto(goal, a);
  const double ra = a.offset - a.normal.dot(goal);
  const double rb = b.offset - b.normal.dot(goal);
  return goal + a.normal * ((ra - c * rb) / det) + b.normal * ((rb - c * ra) / det);
}

// The point nearest to `goal` that all constraints allow. At most two of them are active at once in
// these scenes (no corner of three); then 0, the proxy's own place, is always allowed.
Vector3d nearest_allowed(std::span<const Constraint> constraints, const Vector3d& goal) {
  if (allowed(constraints, goal)) return goal;
  Vector3d best = Vector3d::Zero();
  double best_way = goal.squaredNorm();
  const auto offer = [&](const Vector3d& x) {
    const double way = (goal - x).squaredNorm();
    if (way >= best_way || !allowed(constraints, x)) return;
    best = x;
    best_way = way;
  };
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    offer(onto(goal, constraints[i]));
    for (std::size_t j = i + 1; j < constraints.size(); ++j) {
      offer(onto(goal, constraints[i], constraints[j]));
    }
  }
  return best;
}

}  // namespace

IdealProxy::IdealProxy(const TruthScene& scene, const Vector3d& start)
    : scene_(&scene), position_(start), hip_(start) {}

void IdealProxy::follow(const Vector3d& hip) {
  const Vector3d from = hip_;
  const Vector3d way = hip - from;
  const int steps = std::max(1, static_cast<int>(std::ceil(way.norm() / kStep)));
  for (int i = 1; i <= steps; ++i) settle(from + way * (static_cast<double>(i) / steps));
  hip_ = hip;
}

void IdealProxy::settle(const Vector3d& hip) {
  for (int i = 0; i < kMostSteps; ++i) {
    const Vector3d way = hip - position_;
    const double length = way.norm();
    const Vector3d goal = length > kStep ? Vector3d(way * (kStep / length)) : way;
    std::array<Constraint, kTableParts> constraints;
    for (std::size_t k = 0; k < constraints.size(); ++k) {
      const Distance found = distance_and_normal(scene_->solids[k], position_);
      constraints[k] = {found.gradient, std::min(0.0, -found.value)};
    }
    const Vector3d step = nearest_allowed(constraints, goal);
    position_ += step;
    if (step.norm() < kRest) return;
  }
}

}  // namespace palpate::accuracy
