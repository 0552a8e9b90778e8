#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpate::sensor {

/// A pose from numbers that people and programs wrote down: rounded, so that rotations are a little
/// off; these are set right. Nothing when they are far off (1 %), or beyond 10^6 m.
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& position,
                                                     const Eigen::Quaterniond& rotation);
[[nodiscard]] std::optional<Eigen::Isometry3d> rigid(const Eigen::Vector3d& position,
                                                     const Eigen::Matrix3d& rotation);

struct ListedFrame {
  double stamp = 0;   // s
  std::string image;  // path relative to the list's folder
};

/// Reads a depth.txt ("time file" a line) or an associations.txt ("time file time file" a line, one
/// of them under depth/) of the TUM RGB-D benchmark.
/// @throws Error that names the line, also when times do not grow from line to line.
[[nodiscard]] std::vector<ListedFrame> parse_frame_list(std::string_view text,
                                                        const std::string& name);

/// A pose at a time; none where the file states that tracking was lost.
struct StampedPose {
  double stamp = 0;  // s
  std::optional<Eigen::Isometry3d> pose = Eigen::Isometry3d::Identity();
};

/// Poses in the order of time.
using PoseTrack = std::vector<StampedPose>;

/// Poses of numbered frames, the number counting the frames of the sequence from 0.
struct PosesByOrder {
  std::map<std::size_t, Eigen::Isometry3d> poses;
};

/// Poses of numbered frames, the number standing at the end of the image's name; and what stands
/// behind each pose, such as from the depth camera to the colour camera whose poses they are.
struct PosesByNumber {
  std::map<std::size_t, Eigen::Isometry3d> poses;
  Eigen::Isometry3d T_posed_sensor = Eigen::Isometry3d::Identity();
};

using Poses = std::variant<PoseTrack, PosesByOrder, PosesByNumber>;

/// Reads poses, camera to world: lines "time x y z qx qy qz qw" (TUM), groups of a line of three
/// counts and four of a 4 x 4 matrix (Redwood's .log), or 4 x 4 matrices under comments that name
/// "frame-NUMBER". Numbers that are infinite or no numbers ("nan") state that tracking was lost:
/// that frame has no pose.
/// @throws Error that names the line and what it should be.
[[nodiscard]] Poses parse_poses(std::string_view text, const std::string& name);

/// The pose at a time between two given ones: positions in a straight line, rotations along the
/// shortest arc (slerp). One that is given within a millisecond is taken as it is. Nothing
/// before the first, after the last, in gaps above 0.25 s, and beside a pose that was lost.
[[nodiscard]] std::optional<Eigen::Isometry3d> pose_at(const PoseTrack& track, double stamp);

}  // namespace palpate::sensor
