#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// Position at one time, and how a tool is held there. The caller has to know its frame.
struct TrajectoryRow {
  double time = 0;                                     ///< s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  std::optional<Eigen::Vector3d> force = {};           ///< that was measured there, on the hand, N
  std::optional<Eigen::Quaterniond> orientation = {};  ///< of unit length; unset: held straight
  std::optional<double> opening = {};                  ///< of a gripper, m; unset: closed
};

/// A path in time: times grow strictly from row to row, evenly or not.
using Trajectory = std::vector<TrajectoryRow>;

struct TrajectoryOptions {
  /// Names of the columns in their order, for text that has no header line: `t`, `hip_x`, `hip_y`,
  /// `hip_z`, perhaps `fx`, `fy`, `fz`, `qx`, `qy`, `qz`, `qw`, `gripper`, and any other name for a
  /// column to pass over. Empty: the first line names them.
  std::vector<std::string> columns = {};
  bool forces = false;  ///< reads `fx`, `fy`, `fz`, N, if these columns are there
  /// Called with the words for an orientation by other names: "roll, pitch and yaw taken as
  /// radians", or the names. On this thread, before any row is read.
  std::function<void(const std::string&)> remark = {};
};

/// Reads a trajectory from CSV: a header line that names the columns `t`, `hip_x`, `hip_y`, `hip_z`
/// in any order among any others, then one row a step; seconds and metres. Columns `qx`, `qy`,
/// `qz`, `qw` are an orientation, or such by ROS's names (pose.orientation.x), or else `roll`,
/// `pitch`, `yaw` about the fixed axes x, y, z, in radians unless their names say degrees
/// (roll_deg); `gripper` is an opening. Commas, semicolons or tabs separate; empty
/// lines and lines that begin with # are passed over. Where `options` name the columns, blanks
/// separate, too, rows have as many values as there are names, and # and % begin comments. "-" is
/// standard input.
/// @throws Error that names the file, the line and a remedy when a column is missing, a value is
/// not a finite number, an orientation is not whole or of unit length, or times do not grow
/// strictly.
[[nodiscard]] Trajectory read_trajectory(const std::filesystem::path& path,
                                         const TrajectoryOptions& options = {});

/// The same from a stream. `name` stands for it in messages.
[[nodiscard]] Trajectory read_trajectory(std::istream& stream, const std::string& name,
                                         const TrajectoryOptions& options = {});

}  // namespace palpate
