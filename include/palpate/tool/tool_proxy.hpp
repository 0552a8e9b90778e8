// The proxy of a tool that turns: position, orientation and opening, forces and torques.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "palpate/contact/proxy.hpp"
#include "palpate/field/field.hpp"
#include "palpate/geometry/pose.hpp"
#include "palpate/tool/tool.hpp"
#include "palpate/tool/tool_surface.hpp"

namespace palpate {

struct ToolOptions {
  double stiffness = 500;  ///< K of forces and of the grip, N/m
  Friction friction = {};  ///< of every contact (docs/method.md 4.1)
  Texture texture = {};    ///< under every sample (docs/method.md 4.2)
  /// g, m, 1e-4 to 10: turns have the stiffness K g^2 (N m/rad). 0: the tool's radius of gyration,
  /// at least 10 mm and at most half of its extent (1 mm for a point).
  double gyration = 0;
  /// Looks at the surface that a step in contact takes before it settles, 2 to 6: more follow a
  /// fast hand over strong curvature more closely.
  int iterations = 2;
};

/// What one step of a tool's proxy gives.
struct ToolContact {
  /// Where a sample of the tool presses on the surface. The forces of all touches and what friction
  /// holds there add up to the wrench once the hand rests.
  struct Touch {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the sample, m, world
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< of the surface, outward, unit
    double force = 0;                                    ///< along the normal, N
    Eigen::Vector3d friction = Eigen::Vector3d::Zero();  ///< along the surface, N
    int sample = -1;                                     ///< of Tool::samples()
  };
  /// Six constraints hold a rigid tool, a seventh a gripper's opening.
  static constexpr int kMostTouches = 7;

  /// On the hand: K (proxy - hand), K g^2 times the turn from hand to proxy, and what is left of
  /// springs that a change of the surface ended.
  Wrench wrench;
  Pose proxy;
  double stiffness = 0;   ///< of all springs in the force, N/m
  bool touching = false;  ///< held by a surface
  bool sliding = false;   ///< friction yielded in this step
  std::array<Touch, kMostTouches> touches{};
  int touch_count = 0;
  int iterations = 0;   ///< looks at the surface
  int evaluations = 0;  ///< field samples, ball tests and surfaces asked for
  int source = -1;      ///< index of the source that presses most; -1: none
  ContactNote notes = ContactNote::none;
};

/// The god-object of a tool: where the hand is, as far as no sample of the tool enters a solid, by
/// the least motion in the metric diag(K, K g^2) (docs/method.md 3.7).
///
/// Experimental. Exact on analytic fields (palpate/field/analytic.hpp); on clouds by a ToolField.
/// Any other field serves one point: a SceneField holds a tool that is wider than what it gathers.
/// Balls of samples are at most 0.3 R: a larger one can sink in where only its middle is within R.
/// Nothing waits for a surface that vanishes: the tool goes to the hand at once.
///
/// One proxy belongs to one thread. step() and reset() never allocate, lock, throw or call the
/// system. Input that is not finite or in range (an orientation whose length is
/// not about 1) latches a fault: a zero wrench until reset(). More than half a turn
/// between hand and proxy is taken the short way round.
class ToolProxy {
 public:
  /// @throws Error without a tool, and when an option is not finite or out of its range.
  explicit ToolProxy(std::shared_ptr<const Tool> tool, const ToolOptions& options = {});
  ~ToolProxy();
  ToolProxy(ToolProxy&&) noexcept;
  ToolProxy& operator=(ToolProxy&&) noexcept;

  /// Moves the tool towards the hand (world). `dt` is the time since the last step, s, at least 0.
  /// The first step after construction or reset() puts the tool where the hand is; what is solid
  /// there pushes it out, softly: stiffness comes with the hand's motion. Where one step does not
  /// bring it out it touches nothing until it has been outside (ContactNote::inside). Spends at
  /// most max_evaluations(). An opening below 0 is taken for 0: a gripper that is closed on nothing
  /// gives no grip.
  ///
  /// A surface that knows the samples of another tool is a fault, too.
  ///
  /// What was seen of a field holds in the next steps as long as its traits stay and it keeps to
  /// the side of a surface that it has decided for; reset() comes before another field, which may
  /// lie where the old one lay.
  [[nodiscard]] ToolContact step(const ToolSurface& surface, const Pose& hand, double dt) noexcept;
  /// The same of a field that serves all samples alike.
  [[nodiscard]] ToolContact step(const Field& field, const Pose& hand, double dt) noexcept;

  /// Another stiffness of forces and turns, N/m, finite and not below 0, another friction and
  /// texture, in the range that the constructor takes, from the next step on; in contact stiffness
  /// changes as the energy tank allows (docs/method.md 3.5).
  void change(double stiffness, const Friction& friction, const Texture& texture) noexcept;

  /// Is the tool somewhere? It is nowhere until the first step or reset(), and while a fault lasts.
  [[nodiscard]] bool has_begun() const noexcept;
  /// Where the tool is. Before it has begun it is the origin, which says nothing.
  [[nodiscard]] const Pose& pose() const noexcept;
  /// The gyration is the one in use.
  [[nodiscard]] const ToolOptions& options() const noexcept;
  [[nodiscard]] const Tool& tool() const noexcept;
  /// Evaluations of the field in a step, at most. Some 500 samples bear 1 kHz on analytic fields.
  [[nodiscard]] int max_evaluations() const noexcept;

  /// Puts the tool at `pose` and forgets contact and faults.
  void reset(const Pose& pose) noexcept;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate
