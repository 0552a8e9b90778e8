#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "field/evaluate.hpp"
#include "palpate/field/field.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"

namespace palpate {

/// A reader's registration at a source: it keeps the current snapshot and, while its start lies
/// ahead, the next. Everything but construction and destruction is real-time.
class SnapshotReader {
 public:
  /// @throws Error when the source has no room for another reader.
  SnapshotReader(Handoff<Snapshot>& handoff, const std::string& name);
  ~SnapshotReader();
  SnapshotReader(const SnapshotReader&) = delete;
  SnapshotReader& operator=(const SnapshotReader&) = delete;

  /// Looks for a new snapshot. True when the next one has become the current one; false, too, when
  /// the surface was taken away, and current() is null then. A snapshot that waits for its start is
  /// replaced by a newer one only when it starts unreasonably late.
  bool advance(double now) noexcept;

  [[nodiscard]] const Snapshot* current() const noexcept { return current_; }  ///< or nullptr
  /// Snapshot::publication of the newest one that it took; 0: none yet.
  [[nodiscard]] std::uint64_t taken() const noexcept { return taken_; }
  [[nodiscard]] std::size_t reader() const noexcept { return reader_; }  ///< its number

 private:
  void look(double now) noexcept;

  Handoff<Snapshot>* handoff_;
  std::size_t reader_;
  std::size_t slot_ = 0;  // that holds `current_`; the other holds `next_`
  const Snapshot* current_ = nullptr;
  const Snapshot* next_ = nullptr;
  std::uint64_t taken_ = 0;
};

/// One source's surface in time, as one reader sees it. Everything but construction and destruction
/// is real-time.
class SourceView {
 public:
  /// `least_radius`: of all its layers' points, m; may change. `name`: of the reader.
  /// @throws Error when the source has no room for another reader.
  SourceView(Handoff<Snapshot>& handoff, const std::atomic<double>& least_radius,
             const std::string& name)
      : snapshots_(handoff, name), wanted_radius_(&least_radius) {}

  /// Looks for a new snapshot and brings everything to time `now`, s, which is finite. True when
  /// that moved or changed the surface. A snapshot that came after its start makes up for it.
  bool advance(double now) noexcept;

  /// nullptr: no surface now; one that has faded away is none.
  [[nodiscard]] const Snapshot* current() const noexcept {
    return share_ > 0 ? snapshots_.current() : nullptr;
  }

  /// The current snapshot's presence now, 0-1; 0 without one. Rises no faster than it would fade.
  [[nodiscard]] double presence() const noexcept { return presence_; }

  /// The current snapshot's k-th layer as it counts now. Once presence has come to 0 the weights
  /// fade as well: what other sources see there goes over to them gradually.
  [[nodiscard]] ActiveLayer layer(std::size_t k, int source) const noexcept;

  /// Has the source points in the ball that no layer of the current snapshot holds yet?
  [[nodiscard]] bool misses(const Ball& ball) const noexcept;

  /// Snapshot::publication of the newest snapshot that it took; 0: none yet.
  [[nodiscard]] std::uint64_t taken() const noexcept { return snapshots_.taken(); }

  /// The radius to which all supports are widened now, m.
  [[nodiscard]] double least_radius() const noexcept { return least_radius_; }

  /// The reader's number at the source.
  [[nodiscard]] std::size_t reader() const noexcept { return snapshots_.reader(); }

 private:
  /// What is remembered of a snapshot that is released.
  struct Times {
    double start = 0;
    double end = 0;
    std::uint64_t sequence = 0;
  };

  void begin(const Times& before) noexcept;
  void move(double now) noexcept;
  void fade(double now, double dt) noexcept;

  SnapshotReader snapshots_;
  const std::atomic<double>* wanted_radius_;
  double shown_ = -std::numeric_limits<double>::infinity();  // time of the last advance(), s
  double begun_ = 0;     // when the current one began to be shown, s
  double lag_ = 0;       // how far its surface lagged then, in durations, ...
  double catch_up_ = 1;  // ... and the time in which it catches up, s
  double least_radius_ = 0;
  double progress_ = 0;
  double rate_ = 0;  // of progress, 1/s
  double presence_ = 0;
  double share_ = 0;  // of the weights
  double faded_ = 0;  // time since presence came to 0, s
};

/// For how long a snapshot is shown, or the time to the one that follows, s.
[[nodiscard]] inline double time_shown(const Snapshot& snapshot) noexcept {
  return std::max(snapshot.end - snapshot.start, snapshot.interval);
}

/// How long a cloud's snapshot has to last by its sensor's rate, s. Clouds whose surfaces come late
/// are apart for that reason: the longer tools reach, the later these come.
[[nodiscard]] inline double time_to_next(const Snapshot& cloud) noexcept {
  return std::max(std::min(time_shown(cloud), kLateCloud), cloud.spare);
}

/// For how long a surface that a snapshot shows may have moved unseen, s: time_shown() if it
/// shows points at once that were not among the layers `before`. 0: it goes on from what was there.
[[nodiscard]] double time_stepped(const Snapshot& snapshot,
                                  std::span<const ActiveLayer> before) noexcept;

/// The layers that a field's sources show now, and what holds of them together.
struct ActiveLayers {
  std::array<ActiveLayer, Scene::kMaxSources * Snapshot::kMaxLayers> layers;
  std::size_t count = 0;
  double least_typical = 0;   ///< least of the layers' typical radii, m; of no layer: infinite
  double cloud_duration = 0;  ///< of snapshots whose points do not move, or between them, s
  double frame_interval = 0;  ///< the longest of any source, s
  bool other_kernel = false;
  bool moving = false;       ///< do points or their weights change now?
  bool plain_points = true;  ///< no materials, no motion, no fading

  [[nodiscard]] std::span<const ActiveLayer> active() const noexcept {
    return {layers.data(), count};
  }
  /// m; 0 without a layer.
  [[nodiscard]] double typical_radius() const noexcept { return count > 0 ? least_typical : 0; }

  /// Real-time, as is add().
  void clear() noexcept;

  /// Adds what a source shows, of which `source` is the number.
  void add(const SourceView& view, int source, const FieldOptions& options) noexcept;
};

/// The stiffness and friction factors at a position of a source's surface.
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

}  // namespace palpate
