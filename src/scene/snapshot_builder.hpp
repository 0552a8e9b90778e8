#pragma once

#include <memory>
#include <span>
#include <vector>

#include "palpate/scene/source.hpp"
#include "scene/frame_timing.hpp"
#include "scene/policies/fusion.hpp"
#include "scene/policies/morph.hpp"
#include "scene/recycler.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {

/// A frame or cloud on its way into a source.
struct Arrival {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
  std::span<const Reach> reach;  ///< of all fields, world frame
  const StartTime& start;
};

/// Makes a source's snapshots out of what is pushed into it, as its policy says. One thread uses
/// it; what it gives out comes back to it by itself and is used again.
class SnapshotBuilder {
 public:
  /// @throws Error when an option is out of its range.
  explicit SnapshotBuilder(const SourceOptions& options);

  /// @throws Error as DepthFilter::filter does, and when a time is not finite.
  [[nodiscard]] std::shared_ptr<const Snapshot> take(const DepthFrame& frame,
                                                     const Arrival& arrival);

  /// nullptr: no point of the cloud is within reach. `report`: of its preparation.
  /// @throws Error as prepare() does, when a time is not finite, and when the policy is morph.
  [[nodiscard]] std::shared_ptr<const Snapshot> take(const PointCloud& cloud, double stamp,
                                                     const Arrival& arrival, PrepareReport& report);

  /// A surface that stays: the newest frame's, all of it fitted, from where the last snapshot ends.
  /// nullptr: `newest` was not made here.
  [[nodiscard]] std::shared_ptr<Snapshot> last_of_frames(const Snapshot& newest);

  /// How many snapshots of clouds or of depth frames may be in use at a time while so many fields
  /// look at them: N + 2 and one for each.
  [[nodiscard]] std::size_t most_snapshots(bool clouds, std::size_t fields) const;

  [[nodiscard]] double interval() const { return interval_filter_.interval(); }
  [[nodiscard]] const NoiseModel& noise() const { return noise_; }
  [[nodiscard]] double median_depth() const { return median_depth_; }

 private:
  struct Empty {
    void operator()(Snapshot& snapshot) const noexcept { snapshot.layers.clear(); }
  };

  [[nodiscard]] std::shared_ptr<Snapshot> morphed(const MorphInput& input,
                                                  const FrameTiming& moment);
  [[nodiscard]] std::shared_ptr<const Snapshot> fused(const FrameTiming& moment);
  [[nodiscard]] FrameTiming next_timing(double stamp, const StartTime& start);
  [[nodiscard]] std::shared_ptr<Snapshot> next_snapshot(const FrameTiming& moment, Policy policy);
  [[nodiscard]] double presence_at(double time) const;
  void forget();
  [[nodiscard]] PointCloud within_reach(const PointCloud& cloud, const Arrival& arrival) const;
  void note_noise(const FilteredDepth& depth);

  SourceOptions options_;
  Policy frames_;  // the policies for depth frames and for clouds
  Policy clouds_;
  FrameIntervalFilter interval_filter_;
  DepthFilter filter_;
  Morph morph_;
  LayerHistory layers_;
  Fusion fusion_;
  Recycler<SurfacePoints> points_;
  Recycler<Snapshot, Empty> snapshots_;
  Snapshot last_;    // without its layers
  Pinhole pinhole_;  // of the last frame
  NoiseModel noise_;
  double median_depth_ = 0;
  std::vector<float> depths_;
};

}  // namespace palpate
