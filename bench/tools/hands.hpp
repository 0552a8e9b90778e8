// A hand that wanders with a tool through a surface, and what is counted of it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/numbers.hpp"
#include "palpate/tool/tool_proxy.hpp"

namespace palpate::tools_bench {

/// Goes from one random pose to the next at a random speed, in a ball around `middle` (m). Every
/// few seconds it comes back to where it began, above the ball: there its path is closed.
class WanderingHand {
 public:
  WanderingHand(std::uint64_t seed, const Eigen::Vector3d& middle, double radius);

  /// A millisecond later. `closed`: the hand is where it began.
  [[nodiscard]] const Pose& next();
  [[nodiscard]] bool closed() const { return leg_ == 0 && share_ >= 1; }
  [[nodiscard]] const Pose& start() const { return start_; }

 private:
  [[nodiscard]] Pose random_pose();
  [[nodiscard]] double even(double least, double most) {
    return least + (most - least) * random_.uniform();
  }

  Random random_;
  Eigen::Vector3d middle_;
  double radius_;
  Pose start_;
  Pose from_;
  Pose to_;
  Pose now_;
  double share_ = 1;  // of the way to the next pose
  double step_ = 1;   // of it in a millisecond
  int leg_ = 0;       // of an excursion
};

/// What a hand met.
struct Met {
  std::uint64_t steps = 0;
  std::uint64_t touching = 0;
  std::uint64_t open = 0;        ///< steps whose iterations ran out
  std::uint64_t not_finite = 0;  ///< or faults
  std::uint64_t looked = 0;      ///< samples whose depth was looked at
  std::uint64_t deep = 0;        ///< of these, deeper than `allowed`
  double deepest = 0;            ///< R
  double given = 0;              ///< J, the most on one closed path
  std::vector<float> touch_us;   ///< of steps in contact, update and step
  std::vector<float> free_us;    ///< of the others
};

/// What the hand moves in: updated, stepped, and asked for its deepest sample.
struct Stage {
  std::function<void(double now, const Pose& hand, const ToolProxy& proxy)> update;
  std::function<ToolContact(ToolProxy&, const Pose& hand)> step;
  /// Calls `see` with the depth (R) of each sample that is near the surface.
  std::function<void(const ToolProxy&, const std::function<void(double)>& see)> depths;
};

/// `allowed`: depth of a sample, R.
[[nodiscard]] Met wander(const Stage& stage, const std::shared_ptr<const Tool>& tool,
                         WanderingHand hand, std::uint64_t steps, double allowed);

/// Processor time of this thread, s.
[[nodiscard]] double thread_seconds();

/// The value that a share of them is below; 0: there are none.
[[nodiscard]] double quantile(std::vector<float>& values, double share);

}  // namespace palpate::tools_bench
