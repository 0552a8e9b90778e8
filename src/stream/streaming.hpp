// Makes a source's snapshots out of frames and clouds that come one after another.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "depth/frame_timing.hpp"
#include "palpate/scene/source.hpp"
#include "scene/recycler.hpp"
#include "scene/source_inside.hpp"
#include "sight/sight.hpp"
#include "stream/layer_history.hpp"
#include "stream/morph.hpp"
#include "stream/one_view.hpp"

namespace palpate {

/// A frame or cloud that enters a source.
struct Arrival {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::span<const Reach> reach;  ///< of all fields, world frame
  const Source::StartTime& start;
};

/// What is stored of a cloud besides its surface.
struct CloudNotes {
  Prepared::Report report = {};                     ///< of the preparation
  std::shared_ptr<const PointCloud> overview = {};  ///< of what was left out, thinned, world frame
  PointCloud whole = {};                            ///< if something was left out
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
};

/// Makes a source's snapshots out of what is pushed into it, by its policy. One thread uses it.
/// Recycles the memory of snapshots that no reader holds.
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
  /// What the last depth frame showed.
  struct Measured {
    Pinhole pinhole;
    NoiseModel noise;
    double median_depth = 0;    // m
    std::vector<float> depths;  // a sample, m; scratch
  };
  /// What the clouds so far showed.
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

/// What a source has for frames, and for clouds that come one after another. All but `sight`,
/// `watched` and `stays` is the preparing thread's; `changed` is guarded by the source's mutex.
struct Streaming {
  /// @throws Error when an option is out of its range.
  explicit Streaming(const SourceOptions& options);

  [[nodiscard]] static Streaming& of(const Source& source);

  void take_change(const Source::Inside& source);
  /// May one more snapshot be made? If not, the source's state contains whom it waits for.
  [[nodiscard]] bool room_for(bool clouds, Source::Inside& source);
  /// `cloud`: null for a frame.
  void hand_over(std::shared_ptr<Snapshot> snapshot, const CloudNotes* cloud, const Source& source);
  /// Notes in the source's state which points the snapshot ends with.
  static void note_surface(const Snapshot& snapshot, Source::Inside& source);
  /// Notes there what a snapshot of the newest frame reports.
  void note(const Snapshot& snapshot, Source::Inside& source) const;
  /// Lets the frame decide which regions are free.
  void show(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor);
  /// The ages up to which a frame can show what is free.
  [[nodiscard]] FrameLimits frame_limits(const Source::Inside& source) const;

  std::unique_ptr<SnapshotBuilder> builder;
  std::unique_ptr<SnapshotBuilder> changed;  // for the next push
  std::vector<Reach> found;
  CloudNotes notes;           // of the last cloud
  std::uint64_t changes = 0;  // taken
  SourceOptions taken;        // with the last of them
  Sight sight;
  std::atomic<bool> watched{false};  // is seen() called?
  std::atomic<bool> stays{false};    // is that an image of set(), and no stream's frame?
};

}  // namespace palpate
