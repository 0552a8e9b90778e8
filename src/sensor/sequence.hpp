#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::sensor {

/// Contents of a sequence.json; docs/sequences.md explains every field.
struct SequenceDescription {
  CameraModel camera;        // fx 0: its lens is not described, as clouds need none
  double depth_unit = 1e-3;  // m
  std::vector<std::uint16_t> invalid;
  bool swapped = false;
  std::optional<double> rate;  // Hz; unset: not given
  std::string images;          // folder; empty: not given
  std::string frames;          // file that lists times and images; empty: all images by name
  std::vector<double> stamps;  // s, one an image; empty: by rate
  std::string poses;           // file; empty: none
  bool world_to_camera = false;
  /// Pose of the depth camera in the frame whose pose is given.
  Eigen::Isometry3d T_posed_sensor = Eigen::Isometry3d::Identity();
};

/// @throws Error that names the field and what it may be.
[[nodiscard]] SequenceDescription parse_description(std::string_view text, const std::string& name);

}  // namespace palpate::sensor

namespace palpate {

struct SequenceFrame {
  std::filesystem::path image;                        ///< or cloud
  double stamp = 0;                                   ///< when it was taken, s since any start
  std::optional<Eigen::Isometry3d> T_world_sensor{};  ///< at the stamp, where poses are given
};

/// Depth images or clouds one after another, as docs/sequences.md describes them.
struct Sequence {
  std::string name;                    ///< for messages: the folder
  CameraModel camera;                  ///< width and height 0: whatever the images have
  double depth_unit = 1e-3;            ///< metres a step of the images
  std::vector<std::uint16_t> invalid;  ///< "nothing measured", besides 0 and 65535
  bool swapped = false;                ///< images hold the less significant byte first
  double rate = 30;                    ///< frames a second, Hz
  std::string assumed = {};            ///< as CameraInfo has it
  bool posed = false;                  ///< poses are given; a frame without one is out of use
  std::vector<SequenceFrame> frames;   ///< stamps grow strictly
};

/// Is a frame of a sequence a cloud rather than a depth image, by its name?
[[nodiscard]] bool is_cloud(const std::filesystem::path& frame);

/// Reads the description of a sequence, no image: `folder` holds a sequence.json, or a depth.txt or
/// associations.txt as TUM's RGB-D benchmark has them, or clouds.
/// @throws Error that names the file, the position in it and a remedy.
[[nodiscard]] Sequence read_sequence(const std::filesystem::path& folder);

struct SequenceOptions {
  const Clock* clock = nullptr;  ///< frames are shown at their time on it; outlives the camera.
                                 ///< Null: as fast as they are requested
  bool loop = false;             ///< begins again at the end, one frame's time after the last
};

/// A camera that plays a sequence. Every frame is shown, in order: one that is requested too late
/// is shown at once. Stamps go on as recorded, from DepthCamera::begin() on; without that from when
/// the first frame is requested, and from 0 without a clock. An image that is missing, broken, of
/// another size, or without the pose that others have is damaged when its turn comes, and the next
/// is as good as ever.
/// @throws Error when there is no frame.
[[nodiscard]] std::unique_ptr<DepthCamera> open_sequence(Sequence sequence,
                                                         const SequenceOptions& options = {});

}  // namespace palpate
