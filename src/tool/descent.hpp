// One step's motion of a tool: to the pose nearest to the hand that keeps its samples out.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "palpate/tool/tool_proxy.hpp"
#include "tool/gap_search.hpp"
#include "tool/tool_friction.hpp"

namespace palpate {

/// What touches, as the solver left it.
struct Touches {
  /// A constraint that presses.
  struct Touch {
    int sample = -1;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, outward, unit
    double multiplier = 0;                             ///< m; times the stiffness a force
    Eigen::Vector3d held = Eigen::Vector3d::Zero();    ///< along the surface, by friction, m
  };
  std::array<Touch, ToolContact::kMostTouches> all{};
  int count = 0;
  double dissipated = 0;  ///< by friction in this step, J
  bool slides = false;    ///< does a contact slide?

  [[nodiscard]] std::span<const Touch> span() const noexcept {
    return {all.data(), static_cast<std::size_t>(count)};
  }
};

/// Moves a tool's pose (docs/method.md 3.7). Iterates: linearises the surface at the samples near
/// it, solves for the least motion, and moves as far as that is right. Real-time.
class Descent {
 public:
  static constexpr double kOutside = 0.01;  ///< of R: no sample is deeper of a tool that is outside

  /// `iterations`: looks in contact before it settles.
  Descent(std::shared_ptr<const Tool> tool, const Metric& metric, int iterations);

  /// The surface has moved by this at most, m; infinite: what was known of it is forgotten.
  void shift(double moved) noexcept;
  /// The tool is put there, and touches nothing; `free`: it is known to be outside.
  void put(const Pose& pose, bool free) noexcept;
  /// The surface has changed: lifts the tool, which touches it, to where each touch finds it again
  /// within `reach` (m) above.
  void lift(const ToolSurface& surface, double reach, ToolContact& contact) noexcept;
  /// Goes where the hand is, as far as the surface and its friction let it; `moved`: how far any
  /// sample of the hand has moved since the last step, m, at most.
  /// False: it was outside neither in this step nor in the one before.
  bool follow(const ToolSurface& surface, const Pose& hand, double moved, const FrictionLaw& law,
              ToolContact& contact) noexcept;

  [[nodiscard]] const Pose& pose() const noexcept { return pose_; }
  [[nodiscard]] const Touches& touches() const noexcept { return touches_; }
  [[nodiscard]] GapSearch& gaps() noexcept { return gaps_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  /// The farthest that any sample moves with this, m, at most.
  [[nodiscard]] double farthest(const Motion& motion) const noexcept;
  /// What a step asks a field, at most.
  [[nodiscard]] static int most_evaluations(const Tool& tool) noexcept;

 private:
  static constexpr double kSolved = 1e-11;  // m, that the solver leaves open: 5e-9 N at 500 N/m
  static constexpr double kLongest = 0.25;  // of R, that a sample moves between two looks
  static constexpr int kMostLooks = 10;  // six towards the hand, four out of what was not foreseen

  // A pose that was looked at without a sample in the surface.
  struct Outside {
    Pose pose;
    bool is_old = false;  // seen before this step
  };
  // A step's first pose, if no sample was in the surface there.
  struct First {
    Pose pose;
    Touches touches;
    double farthest = std::numeric_limits<double>::infinity();  // m from the hand that it may end
  };
  // What a step has seen so far.
  struct Progress {
    Motion motion = Motion::Zero();  // the last one
    Motion pull = Motion::Zero();    // that it is the allowed share of
    double margin = 0;               // m, of the next look
    int held = 0;                    // looks with something active
    bool moves = false;              // does the surface move on?
    int shortened = 0;               // motions that were
    bool settles = false;
    bool finite = true;    // the last motion is
    bool whole = true;     // the last motion was not shortened
    bool proved = true;    // nor so long that what it leads to has to be looked at
    bool creased = false;  // it led into a face that the look before did not show
    First first = {};
  };

  [[nodiscard]] bool iterate(const ToolSurface& surface, const Pose& hand, bool restores,
                             Progress& step, ToolContact& contact) noexcept;
  [[nodiscard]] LeastMotion solve(const Motion& wanted) noexcept;
  [[nodiscard]] bool restore(const Look& look, Progress& step) noexcept;
  double move(const LeastMotion& least, std::size_t seen, const Look& look,
              Progress& step) noexcept;
  [[nodiscard]] bool goes_on(const LeastMotion& pull, double far, const Look& look,
                             Progress& step) noexcept;
  void add_planes() noexcept;
  void remember_planes(const LeastMotion& least, std::size_t seen, const Motion& motion) noexcept;
  void remember_touches(const LeastMotion& least, bool rubs) noexcept;
  void move_to(const Pose& pose) noexcept;

  std::shared_ptr<const Tool> tool_;
  Metric metric_;
  int iterations_;
  GapSearch gaps_;
  Pose pose_;
  Touches touches_;
  ToolFriction friction_;
  ConstraintList constraints_;
  std::optional<Outside> outside_;  // the last one
  bool moves_ = false;              // has the surface moved on since the last step?
  // Planes that were active in this step, with bounds for motions from where the tool is now.
  std::array<Constraint, kMostLooks * ToolContact::kMostTouches> planes_;
  std::size_t plane_count_ = 0;
};

}  // namespace palpate
