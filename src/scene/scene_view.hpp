#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "field/evaluate.hpp"
#include "field/patch.hpp"
#include "palpate/field/field.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"

namespace palpate {

/// One source's snapshots as one reader sees them: the current one and, while its start lies ahead,
/// the next. Everything but construction and destruction is real-time.
class SourceView {
 public:
  /// `least_radius`: of all its layers' points, m; may change. `name`: of the reader.
  /// @throws Error when the source has no reader's place left.
  SourceView(Handoff<Snapshot>& handoff, const std::atomic<double>& least_radius,
             const std::string& name);
  ~SourceView();
  SourceView(const SourceView&) = delete;
  SourceView& operator=(const SourceView&) = delete;

  /// Looks for a new snapshot and brings everything to time `now`, s, which is finite. True when
  /// that moved or changed the surface. A snapshot that waits for its start is replaced by a newer
  /// one only when it starts unreasonably late; one that came after its start makes up for it.
  bool advance(double now) noexcept;

  /// nullptr: no surface now; one that has faded away is none.
  [[nodiscard]] const Snapshot* current() const noexcept { return share_ > 0 ? current_ : nullptr; }

  /// How sure the current snapshot is now, 0-1; 0 without one. Rises no faster than it would fade.
  [[nodiscard]] double presence() const noexcept { return presence_; }

  /// The current snapshot's k-th layer as it counts now. Once presence has come to 0 the weights
  /// fade as well: what other sources see there goes over to them gradually.
  [[nodiscard]] ActiveLayer layer(std::size_t k, int source) const noexcept;

  /// Snapshot::publication of the newest snapshot that it took; 0: none yet.
  [[nodiscard]] std::uint64_t taken() const noexcept { return taken_; }

  /// What all supports are widened to now, m.
  [[nodiscard]] double least_radius() const noexcept { return least_radius_; }

  /// The reader's place at the source.
  [[nodiscard]] std::size_t reader() const noexcept { return reader_; }

 private:
  /// What is remembered of a snapshot that is let go.
  struct Times {
    double start = 0;
    double end = 0;
    std::uint64_t sequence = 0;
  };

  void look(double now) noexcept;
  void forget() noexcept;
  void change_over(double now) noexcept;
  void begin(const Times& before) noexcept;
  void move(double now) noexcept;
  void fade(double now, double dt) noexcept;

  Handoff<Snapshot>* handoff_;
  const std::atomic<double>* wanted_radius_;
  std::size_t reader_;
  std::size_t slot_ = 0;  // that holds `current_`; the other holds `next_`
  const Snapshot* current_ = nullptr;
  const Snapshot* next_ = nullptr;
  double shown_ = -std::numeric_limits<double>::infinity();  // time of the last advance(), s
  double begun_ = 0;     // when the current one began to be shown, s
  double behind_ = 0;    // how far its surface was behind then, in durations, ...
  double catch_up_ = 1;  // ... and in which time it makes up for that, s
  std::uint64_t taken_ = 0;
  double least_radius_ = 0;
  double progress_ = 0;
  double rate_ = 0;  // of progress, 1/s
  double presence_ = 0;
  double share_ = 0;  // of the weights
  double faded_ = 0;  // time since presence came to 0, s
};

/// What a place of a source's surface feels like.
[[nodiscard]] inline Surface felt_surface(const PatchSurface& mean,
                                          const SourceOptions::SoftMaterial& soft) noexcept {
  Surface result;
  result.source = mean.source;
  result.presence = mean.presence;
  result.velocity = mean.velocity;
  result.stiffness_factor = soft.stiffness_factor + mean.material * (1 - soft.stiffness_factor);
  result.friction_factor = soft.friction_factor + mean.material * (1 - soft.friction_factor);
  return result;
}

/// What a field has gathered: a patch around the proxy and its way, and one of wherever else it was
/// asked for last. Counts the work and bounds it: of each gather and each walk by itself, and in an
/// update and a proxy's step of all of them together. Real-time but for construction.
class Patches {
 public:
  explicit Patches(const ImplicitSurface& surface) : surface_(&surface) {}

  /// The layers as they are now; the caller keeps them. `same`: they are those of the last call,
  /// later.
  void show(std::span<const ActiveLayer> layers, int sources, bool same) noexcept;

  /// Gathers everything again: the surface is another one.
  void forget() noexcept;

  /// The paper's section III-D: from now on the radius of the point nearest to x is that of all.
  /// Where x is in no point's support, it stays what it was; `first`, m, when there was none.
  void choose_radius(const Eigen::Vector3d& x, double first) noexcept;

  /// What is gathered from now on is seen from the proxy.
  void stand(const Eigen::Vector3d& proxy) noexcept;

  /// The patch around the proxy. Covers nothing when the visits did not suffice.
  void gather_near(const Eigen::Vector3d& center, double extra) noexcept;
  [[nodiscard]] const Patch& near() const noexcept { return near_; }

  /// Looks again at what was gathered before, where the proxy has moved on.
  void face_near() noexcept;

  /// Does it cover all of these balls, and is it not thinned for reaching much farther than
  /// `extra`, m? Where snapshots have changed, their points are looked for again, if that is all
  /// that it takes.
  [[nodiscard]] bool near_covers(std::span<const Ball> balls, double extra) noexcept;

  /// A patch that covers the ball; `margin`, m: how far one that is gathered for it reaches at
  /// least. nullptr: the visits did not suffice, and there is no telling.
  [[nodiscard]] const Patch* at(const Ball& ball, double margin) const noexcept;

  /// Does either patch cover it already?
  [[nodiscard]] bool covers(const Ball& ball) const noexcept {
    return near_.covers(ball) || far_.covers(ball);
  }

  /// Is the ball free? Asks the index; false when there is no telling.
  [[nodiscard]] bool walk_is_free(const Ball& ball) const noexcept;

  /// No notes yet, and all visits left for choose_radius() and gather_near() together.
  void begin_update() noexcept;
  void begin_step() const noexcept;
  /// `last`: where the proxy is then.
  void end_step(const Stance& last) const noexcept;

  /// thinned and work_spent, since begin_update().
  [[nodiscard]] FieldNote notes() const noexcept { return notes_; }
  /// Of the last step, and as many as gathers take the time of.
  [[nodiscard]] int points_summed() const noexcept { return summed_; }
  [[nodiscard]] std::uint64_t gathers() const noexcept { return gathers_; }
  [[nodiscard]] std::uint64_t visits() const noexcept { return visits_; }

 private:
  // Of SceneField::kStepVisits.
  static constexpr int kFreeVisits = SceneField::kStepVisits / 5;  // whether a ball is free
  static constexpr int kGatherVisits = SceneField::kStepVisits - kFreeVisits;

  [[nodiscard]] const Patch* find(const Ball& ball, double margin) const noexcept;
  bool gather(Patch& patch, const Eigen::Vector3d& center, double extra, int& left) const noexcept;
  void count(const Patch& patch, bool whole, int& left) const noexcept;

  const ImplicitSurface* surface_;
  std::span<const ActiveLayer> layers_;
  int sources_ = 1;
  double radius_ = 0;  // R of all points, m; 0: each has its own

  mutable Stance last_;  // after a proxy's last step
  Stance stance_;
  Stance faced_;         // that the near patch was looked at from last
  bool others_ = false;  // the layers are others than those that it was looked at among
  bool to_face_ = false;

  // Samples away from the path are rare and take a patch of their own; that is a cache.
  Patch near_{SceneField::kPatchPoints};
  mutable Patch far_{SceneField::kPatchPoints};
  mutable bool far_is_late_ = false;   // it is of an earlier moment
  int update_visits_ = kGatherVisits;  // that are left
  mutable bool stepping_ = false;
  mutable int gather_visits_ = kGatherVisits;  // that are left
  mutable int free_visits_ = kFreeVisits;
  mutable int summed_ = 0;
  mutable FieldNote notes_ = FieldNote::none;
  mutable std::uint64_t gathers_ = 0;
  mutable std::uint64_t visits_ = 0;
};

}  // namespace palpate
