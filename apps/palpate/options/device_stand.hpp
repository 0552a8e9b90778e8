#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/chosen_source.hpp"
#include "palpate/device/workspace.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

/// What `--device NAME,KEY=VALUE...` says of how a device stands in the scene.
struct DeviceStand {
  std::optional<double> scale = {};                  ///< m in the world for one of the hand's
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of its origin, m in the world, its axes
  std::string frame = {};              ///< source whose camera its axes follow; empty: the world's
  std::optional<int> clutch = {};      ///< button of the clutch
  std::vector<std::string> keys = {};  ///< that were given
};

/// Takes those options off a device's name and leaves the others.
/// @throws UsageError when a value is none, or given twice.
[[nodiscard]] DeviceStand take_stand(std::string& device);

/// The source that `frame` means: "camera" is the one camera that there is.
/// @throws UsageError when there is none, it has no camera, or there are several.
[[nodiscard]] std::string camera_named(const std::string& frame,
                                       const std::vector<ChosenSource>& sources);

/// Turns and moves `workspace`, whose axes are the world's, as `stand` wants it. `camera`: the
/// source in `scene` whose camera the axes follow; empty: none.
void apply(const DeviceStand& stand, const std::string& camera, const Scene& scene,
           Workspace& workspace);

}  // namespace palpate::app
