#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "palpate/geometry/pinhole.hpp"

namespace palpate::app {

/// A cloud as named on the command line: NAME=PATH, or PATH alone.
struct CloudArgument {
  std::string name;  ///< unique among the clouds of one command
  std::string path;  ///< a file, "-" or "synthetic:NAME"
};

/// A pose as named on the command line.
struct PoseArgument {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< T_world_cloud
};

/// The numbers in `text`, separated by commas.
/// @throws UsageError when it is not `count` finite numbers; `option` and `form` go into the
/// message.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                                const std::string& option, const std::string& form);

/// x,y,z in metres.
[[nodiscard]] Eigen::Vector3d parse_point(const std::string& text, const std::string& option);

/// fx,fy,cx,cy in pixels.
[[nodiscard]] Pinhole parse_intrinsics(const std::string& text);

/// NAME=x,y,z,qx,qy,qz,qw; the quaternion is normalised.
[[nodiscard]] PoseArgument parse_pose(const std::string& text);

/// Names every cloud: after NAME=, else after its file, with a number where two would be the same.
/// An argument that is an existing file is never split.
/// @throws UsageError when two explicit names are the same, or standard input is asked for twice.
[[nodiscard]] std::vector<CloudArgument> parse_clouds(const std::vector<std::string>& arguments);

}  // namespace palpate::app
