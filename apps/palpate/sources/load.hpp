#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/source_options.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// A cloud that has been read, and how long that took.
struct LoadedCloud {
  CloudArgument argument;
  CloudFile file;
  double seconds = 0;
};

/// Reads one cloud, file, standard input or synthetic, with progress on standard error.
/// @throws Error as read_cloud_file() does, and when it holds no point.
[[nodiscard]] LoadedCloud load(const CloudArgument& argument, const FileReading& options);

/// Reads those STL and OBJ files, if there are several, whose unit nobody gave: in one unit, which
/// is millimetres where each of them is probably in these. The others are empty.
/// @throws Error as load() does.
[[nodiscard]] std::vector<std::optional<LoadedCloud>> load_in_one_unit(
    const std::vector<SourcePlan>& sources);

/// @throws Error when the points have no intensities, which materials are made of.
void check_intensities(const LoadedCloud& loaded);

/// @throws Error when a voxel filter is wanted for splats, whose points are one a cell already.
void check_voxel(const LoadedCloud& loaded, const PrepareOptions& options);

/// Reads a depth image as one frame of a camera.
/// @throws Error as read_depth_frame() does, and when no intrinsics are given.
[[nodiscard]] DepthFrame load_depth_image(const std::string& path, const ReadOptions& options);

/// Opens the camera or recording that `source` names. Its frames come as they happen on `clock`,
/// which outlives it, or as fast as they are requested without one; its poses, where it has any,
/// are put where the user wants them.
/// @throws Error when it is not there or, without a clock, cannot do but keep its own time.
[[nodiscard]] std::unique_ptr<DepthCamera> open_stream(const SourcePlan& source,
                                                       const Clock* clock);

/// The same at its own pace where it has one, else as fast as its frames are read.
[[nodiscard]] std::unique_ptr<DepthCamera> open_stream_at_any_pace(const SourcePlan& source);

/// The next frame of use, waiting for some seconds at most; where who sends them may come at any
/// time (CameraInfo::awaits_sender), as long as that takes, saying on standard error what is amiss.
/// `failures` counts reads that failed before.
/// @throws Error that names the camera and what it complained of.
[[nodiscard]] DepthFrame first_frame(DepthCamera& camera, std::size_t* failures = nullptr);

/// Did a read give no frame because something is broken?
[[nodiscard]] bool is_failure(DepthCamera::Status status);

}  // namespace palpate::app
