#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// What a sequence.json says; docs/sequences.md tells of every field.
struct SequenceDescription {
  CameraModel camera;
  double depth_unit = 1e-3;  // m
  std::vector<std::uint16_t> invalid;
  bool swapped = false;
  double rate = 30;            // Hz
  std::string images;          // folder; empty: not said
  std::string frames;          // file that lists times and images; empty: all images by name
  std::vector<double> stamps;  // s, one an image; empty: by rate
  std::string poses;           // file; empty: none
  bool world_to_camera = false;
  /// Pose of the depth camera in the frame whose pose is told.
  Eigen::Isometry3d T_told_sensor = Eigen::Isometry3d::Identity();
};

/// @throws Error that names the field and what it may be.
[[nodiscard]] SequenceDescription parse_description(std::string_view text, const std::string& name);

}  // namespace palpate::sensor
