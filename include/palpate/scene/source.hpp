#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/handoff.hpp"
#include "palpate/scene/policy.hpp"
#include "palpate/scene/snapshot.hpp"

namespace palpate {

/// What points of material 0 feel like. Material 1 is as stiff and rough as the proxy's options
/// say, and between the two it goes in a straight line.
struct SoftMaterial {
  double stiffness_factor = 1;  ///< 0-1
  double friction_factor = 1;   ///< 0-1
};

struct SourceOptions {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< pose of the sensor's frame
  PrepareOptions prepare = {};
  SoftMaterial soft = {};         ///< felt where preparation was told to make materials
  PolicyOptions policy = {};      ///< for what is pushed
  DepthFilterOptions depth = {};  ///< for depth frames that are pushed
};

/// Asked once, when a pushed surface is ready: when it is to start being felt, s, on the clock that
/// SceneField::update is given. Live: now plus a lead of 2 ms. In simulated time: the frame's stamp
/// plus the latency.
using StartTime = std::function<double()>;

/// One sensor or file: its pose, and the newest snapshot of what it sees.
class Source {
 public:
  /// @throws Error when an option is out of its range.
  Source(std::string name, const SourceOptions& options);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const SourceOptions& options() const { return options_; }
  [[nodiscard]] const PrepareReport& report() const { return report_; }

  /// Prepares a cloud that stands still and makes it this source's surface. Not real-time.
  /// @throws Error as prepare() does.
  void set(const PointCloud& cloud);

  /// Takes the next frame of a depth camera: filters it, brings it into the surface as the policy
  /// says, publishes. `frame.T_world_sensor`, where set, stands above options().T_world_sensor.
  /// Not real-time; one thread pushes.
  /// @throws Error as DepthFilter::filter does.
  void push(const DepthFrame& frame, const StartTime& start);

  /// Takes the next cloud of a sensor that delivers clouds, taken at `stamp` (s). Likewise.
  /// @throws Error as prepare() does, and when the policy needs depth frames.
  void push(const PointCloud& cloud, double stamp, const StartTime& start);

  /// Makes `snapshot` the newest; nullptr: there is no surface any more. Not real-time.
  /// @throws Error when it has more than Snapshot::kMaxLayers layers, a layer that is not whole, a
  /// weight or presence outside 0-1, or times that are not finite and in order.
  void publish(std::unique_ptr<const Snapshot> snapshot);

  /// The newest surface's first layer, for those who draw or explore; may be null. Not real-time.
  [[nodiscard]] std::shared_ptr<const SurfacePoints> points() const;

 private:
  friend class SceneField;

  std::string name_;
  SourceOptions options_;
  PrepareReport report_;
  mutable std::mutex points_mutex_;  // whoever draws, and the preparing thread
  std::shared_ptr<const SurfacePoints> points_;
  Handoff<Snapshot> handoff_;
};

}  // namespace palpate
