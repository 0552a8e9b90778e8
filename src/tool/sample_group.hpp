// The surface near a group of a tool's samples, and what all groups share.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "field/evaluate.hpp"
#include "palpate/tool/tool_field.hpp"
#include "scene/followed_sources.hpp"

namespace palpate {

class SampleGroup;

/// What the groups of a tool share: the scene's sources as they are now, how the tool is held, the
/// work that is left in a step, and patches for positions away from the tool. Real-time but for
/// construction.
class TouchedScene {
 public:
  TouchedScene(Scene& scene, const Tool& tool, const FieldOptions& options, const std::string& name,
               double scale)
      : surface(options), followed(scene, name, scale), tool_(&tool) {}

  /// What was done, since the update began or in all.
  struct Work {
    FieldNote notes = FieldNote::none;
    std::uint64_t gathers = 0;
    std::uint64_t visits = 0;
  };

  /// The patches away from the tool hold no longer.
  void begin_update() noexcept;
  /// A step has all visits again.
  void begin_step() noexcept;
  void place(const Pose& tool) noexcept { pose_ = tool; }

  /// Gathers the points that reach into a ball. False when the visits did not suffice.
  bool gather(Patch& patch, const Ball& ball, const Stance& stance) noexcept;
  /// Gathers those layers of the patch again that are others now. False as above.
  bool renew(Patch& patch, const Stance& stance) noexcept;
  /// Searches the index; false, too, when the visits did not suffice.
  [[nodiscard]] bool walk_is_free(const Ball& ball) noexcept;
  /// A patch around x, which is no sample's position, with a group's sides; `of` nullptr: with none
  /// decided. nullptr: the visits did not suffice.
  [[nodiscard]] const Patch* patch_away(const Eigen::Vector3d& x, const SampleGroup* of) noexcept;

  /// The field at x, which `patch` covers; nullptr: nothing is known there, so it is solid.
  [[nodiscard]] Sample sample(const Patch* patch, const Eigen::Vector3d& x) noexcept;
  /// Is x deeper (m) than this below the planes of the points around it, behind their solid, which
  /// is thin? So it is where nobody knows.
  [[nodiscard]] bool is_behind(const Patch* patch, const Eigen::Vector3d& x,
                               double deeper) const noexcept;
  /// What it is made of there.
  [[nodiscard]] Surface made_of(const Patch* patch, const Eigen::Vector3d& x) noexcept;

  /// R of all points, m.
  [[nodiscard]] double radius() const noexcept { return followed.layers().typical_radius(); }
  /// Sum of the radii that sources widen all supports to, m.
  [[nodiscard]] double widened() const noexcept {
    double sum = 0;
    for (int k = 0; k < followed.sources(); ++k) {
      sum += followed.view(static_cast<std::size_t>(k)).least_radius();
    }
    return sum;
  }
  [[nodiscard]] bool is_empty() const noexcept { return followed.layers().count == 0; }
  /// The middle of what a finger is, m, world.
  [[nodiscard]] Eigen::Vector3d middle_of(int side) const noexcept;
  /// The samples of a node.
  [[nodiscard]] std::span<const Tool::Point> samples_of(const Tool::Node& node) const noexcept {
    return tool_->samples().subspan(node.begin, node.end - node.begin);
  }
  [[nodiscard]] Eigen::Vector3d in_world(const Tool::Point& sample) const noexcept {
    return tool_->in_world(sample.position, sample.side, pose_);
  }
  /// Where a node of the tool is, and what it is around, m, world.
  [[nodiscard]] Ball ball_of(const Tool::Node& node) const noexcept {
    return {tool_->in_world(node.center, node.side, pose_), node.radius};
  }
  [[nodiscard]] const Work& work() const noexcept { return work_; }

  ImplicitSurface surface;
  FollowedSources followed;

 private:
  // Parts of the visits, as for a point (judgement: a walk tests one ball, a gather takes points).
  static constexpr int kFreeVisits = ToolField::kStepVisits / 5;
  static constexpr int kGatherVisits = ToolField::kStepVisits - kFreeVisits;  // the rest

  struct Away {
    Patch patch{SceneField::kPatchPoints};
    const SampleGroup* of = nullptr;
  };
  void count(const Patch& patch, bool whole) noexcept;

  const Tool* tool_;
  Pose pose_;
  Work work_;
  int gather_visits_ = kGatherVisits;  // left
  int free_visits_ = kFreeVisits;
  std::array<Away, 2> away_;
  std::size_t latest_ = 0;  // of these two, that was used
};

/// The surface near samples of a tool that are close together. Points are gathered once one of the
/// samples looks. Which side of a surface is free is decided from where its last step ended; where
/// none of them has looked for some updates, from where one looks next. Real-time but for
/// construction.
class SampleGroup final : public Field {
 public:
  explicit SampleGroup(TouchedScene& scene) : scene_(&scene) {}

  /// It serves the samples of this node from now on, and knows nothing but on which side of a
  /// surface its finger is.
  void assign(const Tool::Node& node, AgreedSides& finger) noexcept;
  /// Begins an update, `passed` (s) after the last: points have moved (`changed`), and are others
  /// if not `same`.
  void update(double passed, bool changed, bool same) noexcept;
  /// Knows nothing from now on.
  void release() noexcept;
  /// Sides are decided from where a sample looks next, of the points that are known already.
  void forget_sides() noexcept { now_.looks = now_.ready = false; }
  /// Is one of its samples? TouchedScene::is_behind()
  [[nodiscard]] bool is_behind(double deeper) const noexcept;

  [[nodiscard]] const Patch& patch() const noexcept { return now_.patch; }
  /// Has a sample looked of late?
  [[nodiscard]] bool looks() const noexcept { return now_.looks; }
  [[nodiscard]] bool touches() const noexcept { return now_.looks && now_.stance.touches(); }
  /// R of its points, or of all if it has none, m.
  [[nodiscard]] double radius() const noexcept;

  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override;
  [[nodiscard]] Surface surface(const Eigen::Vector3d& x) const noexcept override;
  [[nodiscard]] Traits traits() const noexcept override { return {}; }
  void end_step(const Eigen::Vector3d& proxy,
                const Eigen::Vector3d& normal) const noexcept override;

 private:
  // What calls of a const field change.
  struct Now {
    Patch patch{ToolField::kGroupPoints};
    Stance stance;  // where its last step ended
    Stance faced;   // where sides were decided from last
    bool looks = false;
    bool ready = false;   // is everything as it is in this update?
    bool stale = false;   // have points moved since they were brought forward?
    bool others = false;  // are layers others than those that sides were decided among?
    double unlooked = 0;  // s without a look
  };

  [[nodiscard]] const Patch* patch_for(const Eigen::Vector3d& x) const noexcept;
  void begin_at(const Eigen::Vector3d& x) const noexcept;
  void make_ready() const noexcept;
  [[nodiscard]] bool turns() const noexcept;

  TouchedScene* scene_;
  const Tool::Node* node_ = nullptr;
  AgreedSides* finger_ = nullptr;
  mutable Now now_;
};

}  // namespace palpate
