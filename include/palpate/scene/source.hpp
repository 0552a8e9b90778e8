#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "palpate/scene/handoff.hpp"
#include "palpate/scene/prepare.hpp"
#include "palpate/scene/snapshot.hpp"

namespace palpate {

struct SourceOptions {
  Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();  ///< pose of the sensor's frame
  PrepareOptions prepare;
};

/// One sensor or file: its pose, and the newest snapshot of what it sees.
class Source {
 public:
  Source(std::string name, const SourceOptions& options);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const SourceOptions& options() const { return options_; }
  [[nodiscard]] const PrepareReport& report() const { return report_; }

  /// Prepares a cloud that stands still and makes it this source's surface. Not real-time.
  /// @throws Error as prepare() does.
  void set(const PointCloud& cloud);

  /// Makes `snapshot` the newest. Not real-time.
  void publish(std::unique_ptr<const Snapshot> snapshot);

  /// The static or newest surface, for those who draw or explore; may be null. Not real-time.
  [[nodiscard]] std::shared_ptr<const SurfacePoints> points() const { return points_; }

 private:
  friend class SceneField;

  std::string name_;
  SourceOptions options_;
  PrepareReport report_;
  std::shared_ptr<const SurfacePoints> points_;
  Handoff<Snapshot> handoff_;
};

}  // namespace palpate
