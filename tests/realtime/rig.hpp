#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {

/// What a run of watched steps did.
struct Run {
  Findings offences;  ///< of all steps together
  int steps = 0;
  int touching = 0;  ///< steps in contact
  int sliding = 0;   ///< steps in which friction gave way
  int infinite = 0;  ///< steps with a result that was not finite
  ContactNote contact_notes = ContactNote::none;
  FieldNote field_notes = FieldNote::none;
};

/// A servo step as a user's loop has it, each one watched: SceneField::update and Proxy::step.
class Rig {
 public:
  explicit Rig(Scene& scene, const FieldOptions& field = {}, const ProxyOptions& proxy = {});

  /// One step of 1 ms towards `hip`; what it did is added to run().
  Contact step(const Eigen::Vector3d& hip);

  /// A straight line of `steps` steps from where the hand is to `end`.
  void move(const Eigen::Vector3d& end, int steps);

  /// Called before each step, unwatched: where preparation would be at work.
  void between_steps(std::function<void()> work) { work_ = std::move(work); }

  [[nodiscard]] const Run& run() const { return run_; }
  [[nodiscard]] double now() const { return now_; }
  void set_now(double now) { now_ = now; }

 private:
  SceneField field_;
  Proxy proxy_;
  Run run_;
  Eigen::Vector3d hip_ = Eigen::Vector3d::Zero();
  double now_ = 0;
  std::function<void()> work_;
};

}  // namespace palpate::realtime
