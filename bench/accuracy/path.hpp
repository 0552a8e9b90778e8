#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

/// Paths of a hand, tick by tick.
namespace palpate::accuracy {

inline constexpr double kTick = 1e-3;      ///< s: the servo at 1 kHz
inline constexpr double kStiffness = 500;  ///< N/m; judgement: a usual haptic device holds it
/// m/s, where a path says nothing else; judgement: a hand that explores
inline constexpr double kHandSpeed = 0.05;

/// Where the hand is, tick by tick, whatever it feels. Ticks begin ... end - 1 are scored.
struct Path {
  std::vector<Eigen::Vector3d> hip;  ///< m
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Draws a path. The scored part runs from start_score() to end_score() or the end.
class PathBuilder {
 public:
  explicit PathBuilder(const Eigen::Vector3d& start) { path_.hip.push_back(start); }

  PathBuilder& line_to(const Eigen::Vector3d& goal, double speed = kHandSpeed);
  PathBuilder& hold(double seconds);
  /// Goes along `curve`, a function of 0 ... 1 of the given length (m), easing in and out so that
  /// it may be followed by its reverse without a jolt.
  PathBuilder& curve(const std::function<Eigen::Vector3d(double)>& curve, double length);
  PathBuilder& start_score();
  PathBuilder& end_score();
  [[nodiscard]] Path build() const;

 private:
  Path path_;
};

}  // namespace palpate::accuracy
