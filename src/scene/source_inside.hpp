// Holds what a source is made of: its snapshot builder, its state and its handoff.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/source.hpp"
#include "scene/handoff.hpp"
#include "scene/recycler.hpp"
#include "scene/tool_reach.hpp"
#include "sight/sight.hpp"
#include "stream/frame_timing.hpp"
#include "stream/layer_history.hpp"
#include "stream/morph.hpp"
#include "stream/one_view.hpp"

namespace palpate {

/// How far apart two surfaces are where both are there: the median distance, along the normal of
/// `b`, from points of `a` to the nearest point of `b`, m, where they are going. Points count that
/// have a neighbour within three radii whose normal points the same way within 45 degrees; nothing
/// when fewer than 30 of about a thousand that are tried do.
[[nodiscard]] std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b);

/// How wide supports have to be for the surfaces of sources that disagree to be one.
///
/// Heights of sources unite where the supports of both reach (united_shift()). Further apart
/// than that there is a gap between two sheets, into which a proxy slips where one of them ends. So
/// where two surfaces of a scene lie up to 1.5 R apart, no R of either is below 2.5 times that
/// distance. What lies further apart stays two.
class Seams {
 public:
  /// Compares the newest points of the source at `place` with those of the others that have called
  /// this. The source outlives it. Takes milliseconds, and memory; any thread but a servo's.
  void compare(std::size_t place, const Source& source);

  /// No support radius of that source is to be below this, m. Changes; may be read by any thread.
  [[nodiscard]] const std::atomic<double>& least_radius(std::size_t place) const noexcept {
    return least_radii_[place];
  }

  /// Sets it until the next compare(), for a replay that knows what it was.
  void set_least_radius(std::size_t place, double radius) noexcept {
    least_radii_[place].store(radius);
  }

 private:
  std::mutex mutex_;
  std::array<const Source*, Scene::kMaxSources> sources_{};
  std::array<std::array<double, Scene::kMaxSources>, Scene::kMaxSources> common_{};  // R, m
  std::array<std::atomic<double>, Scene::kMaxSources> least_radii_{};
};

/// A frame or cloud on its way into a source.
struct Arrival {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::span<const Reach> reach;  ///< of all fields, world frame
  const Source::StartTime& start;
};

/// What is known of a cloud besides its surface.
struct CloudNotes {
  Prepared::Report report = {};                     ///< of the preparation
  std::shared_ptr<const PointCloud> overview = {};  ///< of what was left out, thinned, world frame
  PointCloud whole = {};                            ///< if something was left out
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
};

/// Makes a source's snapshots out of what is pushed into it, as its policy says. One thread uses
/// it. Recycles the memory of snapshots that no reader holds.
class SnapshotBuilder {
 public:
  /// @throws Error when an option is out of its range.
  explicit SnapshotBuilder(const SourceOptions& options);

  /// @throws Error as DepthFilter::filter does, and when a time is not finite.
  [[nodiscard]] std::shared_ptr<Snapshot> take(const DepthFrame& frame, const Arrival& arrival);

  /// Where clouds are clipped, the surface is what is within reach, and empty where nothing is.
  /// @throws Error as prepare() does, when a time is not finite, and when the policy is morph.
  [[nodiscard]] std::shared_ptr<Snapshot> take(const PointCloud& cloud, double stamp,
                                               const Arrival& arrival, CloudNotes& notes);

  /// A surface that stays: all of the newest frame fitted, or all of the newest cloud prepared if
  /// it was clipped, from where the last snapshot ends. nullptr: `newest` was not made here, or is
  /// all of it. `notes`: of the newest cloud.
  /// @throws Error as prepare() does.
  [[nodiscard]] std::shared_ptr<Snapshot> last_of(const Snapshot& newest, const CloudNotes& notes);

  /// How many snapshots of clouds or of depth frames may be in use at a time while so many fields
  /// look at them: N + 2 and one for each.
  [[nodiscard]] std::size_t most_snapshots(bool clouds, std::size_t fields) const;

  [[nodiscard]] double interval() const { return interval_filter_.interval(); }
  [[nodiscard]] const NoiseModel& noise() const { return measured_.noise; }
  [[nodiscard]] double median_depth() const { return measured_.median_depth; }

 private:
  /// For depth frames and for clouds.
  struct Policies {
    Policy frames;
    Policy clouds;
  };
  /// What the last depth frame told.
  struct Measured {
    Pinhole pinhole;
    NoiseModel noise;
    double median_depth = 0;    // m
    std::vector<float> depths;  // a sample, m; scratch
  };
  /// What the clouds so far told.
  struct Clouds {
    OneView view;
    int late = 0;  // in a row, whose surfaces came late; from kEnoughLate on it stays
  };
  struct Empty {
    void operator()(Snapshot& snapshot) const noexcept { snapshot.layers.clear(); }
  };

  [[nodiscard]] std::shared_ptr<Snapshot> morphed(const MorphInput& input,
                                                  const FrameTiming& moment);
  [[nodiscard]] FrameTiming next_timing(double stamp, const Source::StartTime& start);
  [[nodiscard]] std::shared_ptr<Snapshot> next_snapshot(const FrameTiming& moment, Policy policy);
  [[nodiscard]] double presence_at(double time) const;
  void forget();
  void note_noise(const FilteredDepth& depth);
  [[nodiscard]] std::shared_ptr<SurfacePoints> filled(Prepared prepared, const PointCloud& cloud,
                                                      const Eigen::Isometry3d& T_world_sensor);

  SourceOptions options_;
  Policies policies_;
  FrameIntervalFilter interval_filter_;
  DepthFilter filter_;
  Morph morph_;
  LayerHistory layers_;
  Recycler<SurfacePoints> points_;
  Recycler<Snapshot, Empty> snapshots_;
  Snapshot last_;  // without its layers
  Measured measured_;
  Clouds clouds_;
};

/// The parts of a source. Its scene and the fields of that scene use them.
struct Source::Inside {
  void take_change();
  [[nodiscard]] bool room_for(bool clouds);
  void hand_over(const Source& source, std::shared_ptr<Snapshot> snapshot,
                 const CloudNotes* cloud = nullptr);
  void note(const Snapshot& snapshot);
  void note_surface(const Snapshot& snapshot);
  void note(const SnapshotBuilder& made);
  void compare(const Source& source);
  void show(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor);
  [[nodiscard]] FrameLimits frame_limits() const;

  /// For those who draw.
  template <class T>
  [[nodiscard]] T copy(T Inside::*member) const {
    const std::lock_guard lock(mutex);
    return this->*member;
  }

  std::string name;
  mutable std::mutex mutex;  // of what follows: those who draw, and the preparing thread
  SourceOptions options;
  std::unique_ptr<SnapshotBuilder> changed;  // for the next push
  Eigen::Isometry3d pose;
  Prepared::Report report;
  std::shared_ptr<const SurfacePoints> points;
  Source::State state;

  std::unique_ptr<SnapshotBuilder> builder;  // the preparing thread's
  std::vector<Reach> found;                  // the same thread's
  CloudNotes notes;                          // of the last cloud; the same thread's
  std::uint64_t publications = 0;            // the same thread's
  std::uint64_t changes = 0;                 // taken; the same thread's
  SourceOptions taken;                       // with the last of them; the same thread's
  ReachTable reaches;
  Sight sight;
  std::atomic<bool> watched{false};  // does anybody ask what is seen?
  std::atomic<bool> stays{false};    // is that an image of set(), and no stream's frame?
  std::shared_ptr<Seams> seams;      // of the scene
  std::size_t place = 0;             // in it
  Handoff<Snapshot> handoff;
};

}  // namespace palpate
