// Declares what a tab touches.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/viewer/viewer.hpp"
#include "session/view_settings.hpp"

namespace palpate::tab {

/// What is touched: a cloud, or what a simulated camera sees.
struct Touched {
  std::string name;  ///< for people
  PointCloud cloud = {};
  std::shared_ptr<DepthCamera> camera = {};   ///< null: the cloud
  std::optional<session::Setting> unit = {};  ///< of a file, by which another one is chosen
};

/// A cloud that a formula makes, or a simulated camera, by its name: "synthetic:torus",
/// "camera:simulated:desk". @throws Error that lists the names.
[[nodiscard]] Touched simulated(const std::string& name);

/// The cloud in the bytes of a file of that name, by read_cloud_bytes(). `unit`: metres a unit; 0:
/// the likely one, and a person is asked where that is no more than likely. @throws Error as it
/// does.
[[nodiscard]] Touched of_file(std::span<const std::byte> bytes, const std::string& name,
                              double unit);

/// A scene of one source, prepared as the page wants it.
class TabSource {
 public:
  using Preparation = session::ViewSettings::Preparation;

  /// Prepares the cloud, or the camera's first frame. @throws Error as preparing does.
  explicit TabSource(Touched touched);

  [[nodiscard]] const std::string& name() const { return touched_.name; }
  /// The setting of the file's unit; unset: there is no file.
  [[nodiscard]] const std::optional<session::Setting>& unit() const { return touched_.unit; }
  [[nodiscard]] Scene& scene() { return scene_; }
  /// The settings that it is prepared by; `initial`: those that it began with.
  [[nodiscard]] const Preparation& preparation() const { return preparation_; }
  [[nodiscard]] const Preparation& initial() const { return initial_; }

  /// What settings are limited by, for a hand of that scale.
  [[nodiscard]] session::ViewScope scope(double scale, const std::vector<Servo*>& servos) const;

  /// What could not be prepared leaves the surface as it was. @throws Error as preparing does.
  void prepare(const Preparation& wanted);

  /// Prepares the frames that are due at `time`, s, which never goes back; those of the first 50 ms
  /// are prepared at once.
  void advance(double time);
  /// The camera as the page shows it.
  [[nodiscard]] std::vector<ViewerOptions::Stream> streams() const;

 private:
  [[nodiscard]] Source& added();

  Touched touched_;
  Scene scene_;
  Source& source_;
  SourceOptions first_;  // as it was at first
  Preparation initial_;  // the same, as settings
  Preparation preparation_;
  CameraModel lens_;
  std::optional<SimulatedStream> stream_;
};

}  // namespace palpate::tab
