#pragma once

#include <Eigen/Core>

#include "palpate/servo/guard.hpp"

namespace palpate::test {

/// The largest step of force that a guard may make (docs/safety.md), computed anew from what it is
/// told: what the hand explains by its own way and its change of velocity, what the slew adds, and
/// a brake that comes or goes, which acts against the hand's way. Where nothing is touched a force
/// that fades may go as the spring that made it.
class AllowedStep {
 public:
  explicit AllowedStep(const GuardOptions& options) : options_(options) {}

  /// From the force of the step before to this one's, N. Every step is told, in their order;
  /// `notes`: the guard's own of this step.
  [[nodiscard]] double operator()(const Guard::Input& input, GuardNote notes);

  /// The next step is the first one again, as after a fault.
  void forget() { begun_ = false; }

 private:
  void begin(const Guard::Input& input);
  [[nodiscard]] double stiffness(const Guard::Input& input) const;
  [[nodiscard]] double brake(const Guard::Input& input) const;

  GuardOptions options_;
  Guard::Input before_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // against the surface, smoothed, m/s
  double spring_ = 0;                                   // that made a force last, N/m
  double brake_ = 0;                                    // of the step before at most, N
  bool begun_ = false;
};

}  // namespace palpate::test
