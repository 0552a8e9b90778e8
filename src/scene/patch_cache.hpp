#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "field/evaluate.hpp"
#include "field/patch.hpp"
#include "palpate/field/field.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {

/// Holds what a field has gathered: a patch around the proxy and its path, and two around
/// wherever else it was evaluated last. Counts the work and bounds it: of each gather and each walk
/// by itself, and in an update and in a proxy's step of all of them together. Real-time but for
/// construction.
class PatchCache {
 public:
  /// The work that was done.
  struct Work {
    FieldNote notes = FieldNote::none;  ///< thinned and work_spent, since begin_update()
    int summed = 0;  ///< points in the last step, and as many as gathers take the time of
    std::uint64_t gathers = 0;
    std::uint64_t visits = 0;
  };

  explicit PatchCache(const ImplicitSurface& surface) : surface_(&surface) {}

  /// Sets the layers as they are now; the caller keeps them. `same`: they are those of the last
  /// call, later.
  void set_layers(std::span<const ActiveLayer> layers, int sources, bool same) noexcept;

  /// Gathers everything again: the surface is another one.
  void forget() noexcept;

  /// The paper's section III-D: from now on the radius of the point nearest to x is that of all.
  /// Where x is in no point's support, it stays what it was; `first`, m, when there was none.
  void take_nearest_radius(const Eigen::Vector3d& x, double first) noexcept;

  /// Sets the proxy (m, world) from which all that is gathered next is seen.
  void set_tool(const Eigen::Vector3d& proxy) noexcept;

  /// Gathers the patch around the proxy. It covers nothing when the visits did not suffice.
  void gather_near(const Eigen::Vector3d& center, double extra) noexcept;
  [[nodiscard]] const Patch& near() const noexcept { return near_.patch; }

  /// Decides the sides of what was gathered before, where the proxy has moved on.
  void face_near() noexcept;

  /// Does the near patch cover all of these balls, and is it not thinned for reaching much farther
  /// than `extra`, m? Where snapshots have changed, their points are gathered again, if that is all
  /// that it takes.
  [[nodiscard]] bool near_covers(std::span<const Ball> balls, double extra) noexcept;

  /// A patch that covers the ball; `margin`, m: the least reach of one that is gathered for it.
  /// nullptr: the visits did not suffice, so nothing is decided.
  [[nodiscard]] const Patch* patch_for(const Ball& ball, double margin) const noexcept;

  /// Does a patch cover it already?
  [[nodiscard]] bool covers(const Ball& ball) const noexcept {
    return near_.patch.covers(ball) || step_.far[0].patch.covers(ball) ||
           step_.far[1].patch.covers(ball);
  }

  /// Is the ball free? Searches the index; false when the visits did not suffice.
  [[nodiscard]] bool walk_is_free(const Ball& ball) const noexcept;

  /// Clears the notes; take_nearest_radius() and gather_near() together get all visits.
  void begin_update() noexcept;
  void begin_step() const noexcept;
  /// `tool`: where the proxy is then.
  void end_step(const Stance& tool) const noexcept;

  [[nodiscard]] const Work& work() const noexcept { return step_.work; }

 private:
  // Parts of SceneField::kStepVisits (judgement: a walk tests one ball, a gather takes points).
  static constexpr int kFreeVisits = SceneField::kStepVisits / 5;
  static constexpr int kGatherVisits = SceneField::kStepVisits - kFreeVisits;  // the rest

  struct Slot {
    Patch patch{SceneField::kPatchPoints};
    bool stale = false;  // must be looked at before it is used: layers or tool have moved on
  };

  /// All that const calls change: what is left of a step's work, what was done, and the patches for
  /// samples away from the path, which are rare. A search that fails looks at the same positions in
  /// every step, and mostly at two that no single patch covers.
  struct Step {
    std::array<Slot, 2> far;
    std::size_t latest = 0;  // of these two, that was used
    Stance last;             // the tool after the last step
    bool running = false;
    int gather_visits = kGatherVisits;  // left
    int free_visits = kFreeVisits;      // left
    Work work;
  };

  void clear_far() noexcept;
  [[nodiscard]] const Patch* find(const Ball& ball, double margin) const noexcept;
  bool gather(Patch& patch, const Eigen::Vector3d& center, double extra, int& left) const noexcept;
  void count(const Patch& patch, bool whole, int& left) const noexcept;

  const ImplicitSurface* surface_;
  std::span<const ActiveLayer> layers_;
  int sources_ = 1;
  double radius_ = 0;  // R of all points, m; 0: each has its own
  Stance tool_;
  Stance faced_;                       // the tool when the near patch's sides were decided last
  bool others_ = false;                // the layers are others than those that it was decided among
  int update_visits_ = kGatherVisits;  // left
  Slot near_;
  mutable Step step_;
};

}  // namespace palpate
