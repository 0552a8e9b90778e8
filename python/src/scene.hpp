#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/scene/scene.hpp"
#include "pushed.hpp"

namespace palpate::python {

/// A scene that Python, fields and servos share: it stays as long as any of them.
struct SharedScene {
  Scene scene;
  std::mutex mutex;                ///< of those who add sources or fields, and of `pushed`
  std::deque<Pushed> pushed = {};  ///< of each source
  /// When a proxy made its last step in it, s; not a number: none did.
  std::atomic<double> time = std::numeric_limits<double>::quiet_NaN();
};

/// State of a source, and why its last frame can be no surface.
struct SourceState : Source::State {
  std::string problem = {};  ///< in words; empty: nothing is known against it
};

/// Source of a shared scene.
struct SharedSource {
  [[nodiscard]] std::string name() const { return source->name(); }
  [[nodiscard]] Eigen::Matrix4d pose() const { return source->pose().matrix(); }
  void set_pose(const Eigen::MatrixXd& T_world_sensor);
  [[nodiscard]] Prepared::Report report() const { return source->report(); }
  [[nodiscard]] SourceState state() const;
  void tell(std::string problem);
  /// Notes when the surface of what is pushed now starts, s.
  void starts(double start);
  void keep();

  std::shared_ptr<SharedScene> scene;
  Source* source = nullptr;
  std::size_t index = 0;  ///< in the scene
  std::mutex mutex = {};  ///< of those who push
};

/// A sensor that delivers points.
struct CloudStream : SharedSource {};

/// A depth camera.
struct Camera : SharedSource {
  CameraModel model = {};
  DepthFilterOptions range = {};                             ///< nearest and farthest
  double unit = 1e-3;                                        ///< metres a step of its 16-bit images
  DepthFrame frame = {};                                     ///< memory of the last image
  double newest = -std::numeric_limits<double>::infinity();  ///< stamp of an image, s
};

}  // namespace palpate::python
