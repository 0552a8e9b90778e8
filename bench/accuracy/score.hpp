#pragma once

#include <Eigen/Core>
#include <vector>

#include "accuracy/path.hpp"
#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

/// Forces and positions of a proxy on a path, tick by tick.
struct Trace {
  std::vector<Eigen::Vector3d> force;  ///< on the hand, K (p - h), N
  std::vector<Eigen::Vector3d> proxy;  ///< m
};

/// The metrics of table A, over the scored ticks in which the ideal proxy is in contact.
struct Score {
  double normal = 0;  ///< angle between rendered and ideal force, RMS, degrees; ticks without
                      ///< any rendered force have no angle and count as lost only
  double force = 0;   ///< |F - F_ideal|, RMS, N
  double ripple = 0;  ///< RMS of the force above 20 Hz, N; 0 for paths shorter than 0.3 s
  double height = 0;  ///< signed distance of the proxy from the true surface, mean, mm
  double lost = 0;    ///< share of ticks with less than 20 % of the ideal force
  double pops = 0;    ///< times that three ticks in a row were lost, once the surface was felt
  double step = 0;    ///< largest change of force from one tick to the next, N
  double peak = 0;    ///< largest force, N
  double energy = 0;  ///< integral of F . dh over the whole path, J; positive: given to the hand
};

/// Scores the paths of one row together.
class Scorer {
 public:
  void add(const Path& path, const Trace& ideal, const Trace& rendered, const TruthScene& scene);
  [[nodiscard]] Score score() const;

 private:
  void add_tick(const Eigen::Vector3d& ideal, const Eigen::Vector3d& rendered);
  void add_ripple(const Path& path, const std::vector<Eigen::Vector3d>& force);
  void add_steps(const Path& path, const std::vector<Eigen::Vector3d>& force);

  Score worst_;  // step, peak, pops and energy are gathered here
  double angle_squares_ = 0;
  double force_squares_ = 0;
  double ripple_squares_ = 0;
  double height_sum_ = 0;
  double ticks_ = 0;
  double angles_ = 0;
  double heights_ = 0;
  double ripples_ = 0;
  double lost_ = 0;
  int lost_run_ = 0;
  bool felt_ = false;
};

/// The ideal proxy's trace on a path.
[[nodiscard]] Trace ideal_trace(const TruthScene& scene, const Path& path);

}  // namespace palpate::accuracy
