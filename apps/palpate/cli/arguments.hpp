// What is named on the command line: sources, poses, numbers.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::app {

// Prefixes of sources that are no files.
inline constexpr std::string_view kSynthetic = "synthetic:";
inline constexpr std::string_view kCamera = "camera:";
inline constexpr std::string_view kSequence = "sequence:";
inline constexpr std::string_view kBag = "bag:";
inline constexpr std::string_view kRos = "ros:";

/// A source as named on the command line: NAME=PATH, or PATH alone.
struct CloudArgument {
  std::string name;  ///< unique among the sources of one command
  std::string path;  ///< a file, "-", "synthetic:NAME", or what lives()
};

/// A pose as named on the command line.
struct PoseArgument {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< T_world_cloud
};

/// The path that a source's text names: of "bag:run.mcap:/camera/depth,frame=odom" run.mcap, of
/// "house.e57#2" house.e57.
[[nodiscard]] std::string file_of(const std::string& source);

/// The numbers in `text`, separated by commas.
/// @throws UsageError when it is not `count` finite numbers; `option` and `form` go into the
/// message.
[[nodiscard]] std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                                const std::string& option, const std::string& form);

/// x,y,z in metres.
[[nodiscard]] Eigen::Vector3d parse_point(const std::string& text, const std::string& option);

/// fx,fy,cx,cy in pixels.
[[nodiscard]] Pinhole parse_intrinsics(const std::string& text);

/// s0,s1,s2 or s0,s1,s2,correlation, where correlation >= 1; or the name of a sensor profile.
[[nodiscard]] NoiseModel parse_noise(const std::string& text);

inline constexpr const char* kPoseForm =
    "x,y,z,qx,qy,qz,qw: metres and a unit quaternion; or 12 or 16 numbers: a matrix row by row";

/// A pose from x, y, z (m), qx, qy, qz, qw (normalised here), or from a 3 x 4 or 4 x 4 matrix.
/// @throws UsageError when these are no rotation and translation; `what` goes into the message.
[[nodiscard]] Eigen::Isometry3d pose_of(const std::vector<double>& values, const std::string& what);

/// NAME=, and what pose_of() takes.
[[nodiscard]] PoseArgument parse_pose(const std::string& text);

/// May a source be called so? Letters, digits, '-', '_' and '.'.
[[nodiscard]] bool is_name(std::string_view text);

/// Takes NAME= off; `name` stays empty where there is none. An argument that is an existing file is
/// never split.
[[nodiscard]] CloudArgument split_argument(const std::string& text);

/// Does a path name something that lives ("camera:...", "sequence:...", "bag:...", "ros:...", an
/// .oni file) instead of a cloud that stands still?
[[nodiscard]] bool lives(const std::string& path);

/// Is there anything behind "camera:", "sequence:", "bag:", "ros:" or "synthetic:"?
[[nodiscard]] bool names_something(const std::string& path);

/// Names every source that has no name yet after its path, with a number where two would be the
/// same.
/// @throws UsageError when two names are the same, a path names nothing, or standard input is
/// requested twice.
void name_all(std::vector<CloudArgument>& sources);

/// Both for each argument.
[[nodiscard]] std::vector<CloudArgument> parse_clouds(const std::vector<std::string>& arguments);

/// The words behind the option's name in an error.
[[nodiscard]] std::string without_option(const std::string& message);

/// Help in lines that fit beside the options' names.
[[nodiscard]] std::string wrapped(const std::string& text);

}  // namespace palpate::app
