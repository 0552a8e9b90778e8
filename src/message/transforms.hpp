#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "message/geometry_types.hpp"

namespace palpate::message {

/// Now on the clock of ROS's stamps, s.
[[nodiscard]] double system_now();
[[nodiscard]] double to_seconds(const Time& time);
/// `seconds` from 0 to 2^31; what is not becomes 0.
[[nodiscard]] Time to_time(double seconds);

/// A pose as messages have it. Nothing when it is not finite, or its rotation not of unit length to
/// 1 %.
[[nodiscard]] std::optional<Eigen::Isometry3d> isometry(const Vector3& translation,
                                                        const Quaternion& rotation);
[[nodiscard]] std::optional<Eigen::Isometry3d> isometry(const Pose& pose);
[[nodiscard]] Pose pose_of(const Eigen::Isometry3d& pose);
[[nodiscard]] Transform transform_of(const Eigen::Isometry3d& pose);
[[nodiscard]] Vector3 vector_of(const Eigen::Vector3d& vector);
[[nodiscard]] Eigen::Vector3d eigen(const Vector3& vector);

/// Tree of frames of reference from /tf and /tf_static, each with a parent. Keeps the last 10 s of
/// moving frames. Not thread-safe.
class Transforms {
 public:
  /// Adds transforms; drops those that make no tree, and those that are no pose, which find()
  /// can report.
  void add(const TFMessage& message, bool is_static);

  /// Transform from the axes of `from` to those of `to` at `stamp` (s), linear and by slerp between
  /// stored poses. nullopt if they are not connected, or the poses of a moving link on either side
  /// are more than 0.5 s apart; `why` then names which.
  [[nodiscard]] std::optional<Eigen::Isometry3d> find(const std::string& to,
                                                      const std::string& from, double stamp,
                                                      std::string* why = nullptr) const;

 private:
  struct StampedPose {
    double stamp = 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  };
  struct Link {
    std::string parent;
    bool is_static = false;
    std::deque<StampedPose> poses;  // in the order of time
  };

  [[nodiscard]] static std::optional<Eigen::Isometry3d> at(const Link& link, double stamp);
  [[nodiscard]] std::vector<std::string> ancestors(const std::string& frame) const;
  [[nodiscard]] std::optional<Eigen::Isometry3d> climb(const std::string& frame,
                                                       const std::string& root, double stamp,
                                                       std::string* why) const;

  void refuse(const std::string& child, const std::string& parent, const Transform& transform);

  std::map<std::string, Link> links_;           // by the child's name
  std::map<std::string, std::string> refused_;  // what was no pose last, in words, by the child
};

}  // namespace palpate::message
