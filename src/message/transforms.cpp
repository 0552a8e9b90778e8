// Keeps the tree of transforms from /tf and answers where one frame is in another.
#include "message/transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace palpate::message {
namespace {

constexpr double kKept = 10;            // s of moving frames (judgement)
constexpr double kWidestGap = 0.5;      // s; no pose is interpolated over more (judgement)
constexpr std::size_t kFrames = 4096;   // frames of a robot (judgement)
constexpr std::size_t kPoses = 20'000;  // of one frame: kKept at 2 kHz (derived)
constexpr double kNanoseconds = 1e9;
constexpr double kOffUnit = 0.01;  // deviation of a quaternion's length from 1 (judgement)

// tf2 ignores a leading slash, and so must we.
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double share) {
  const Eigen::Quaterniond from(a.linear());
  const Eigen::Quaterniond to(b.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = from.slerp(share, to).toRotationMatrix();
  pose.translation() = (1 - share) * a.translation() + share * b.translation();
  return pose;
}

// What keeps a transform from being a pose.
std::string what_is_wrong(const Transform& transform) {
  const Quaternion& q = transform.rotation;
  if (q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0) return "its quaternion is all zeros";
  return fmt::format(
      "its translation is ({}, {}, {}), its quaternion ({}, {}, {}, {}): that is not finite, or "
      "the quaternion's length is not 1",
      transform.translation.x, transform.translation.y, transform.translation.z, q.x, q.y, q.z,
      q.w);
}

void explain(std::string* why, std::string words) {
  if (why != nullptr) *why = std::move(words);
}

}  // namespace

double system_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

double to_seconds(const Time& time) {
  return time.sec + time.nanosec / kNanoseconds;
}

Time to_time(double seconds) {
  if (!(seconds >= 0 && seconds < 2147483647)) return {};
  const double whole = std::floor(seconds);
  const auto rest = static_cast<std::uint32_t>((seconds - whole) * kNanoseconds);
  return {static_cast<std::int32_t>(whole), rest};
}

std::optional<Eigen::Isometry3d> isometry(const Vector3& translation, const Quaternion& rotation) {
  const Eigen::Quaterniond q(rotation.w, rotation.x, rotation.y, rotation.z);
  const Eigen::Vector3d t = eigen(translation);
  if (!t.allFinite() || !(std::abs(q.norm() - 1) < kOffUnit)) return {};
  Eigen::Isometry3d pose(q.normalized());
  pose.translation() = t;
  return pose;
}

std::optional<Eigen::Isometry3d> isometry(const Pose& pose) {
  return isometry(Vector3{pose.position.x, pose.position.y, pose.position.z}, pose.orientation);
}

Pose pose_of(const Eigen::Isometry3d& pose) {
  const Transform same = transform_of(pose);
  return {{same.translation.x, same.translation.y, same.translation.z}, same.rotation};
}

Transform transform_of(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  return {vector_of(pose.translation()), {q.x(), q.y(), q.z(), q.w()}};
}

Vector3 vector_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d eigen(const Vector3& vector) {
  return {vector.x, vector.y, vector.z};
}

void Transforms::add(const TFMessage& message, bool is_static) {
  for (const TransformStamped& stamped : message.transforms) {
    const std::string child = plain(stamped.child_frame_id);
    const std::string parent = plain(stamped.header.frame_id);
    const auto pose = isometry(stamped.transform.translation, stamped.transform.rotation);
    const bool is_new = !links_.contains(child);
    if (child.empty() || parent.empty() || (is_new && links_.size() >= kFrames)) continue;
    if (!pose) {
      refuse(child, parent, stamped.transform);
      continue;
    }
    refused_.erase(child);
    if (is_new || links_[child].parent != parent) {
      if (child == parent || std::ranges::count(ancestors(parent), child) > 0) continue;  // a loop
      links_[child] = {parent, is_static, {}};
    }
    Link& link = links_[child];
    link.is_static = is_static;
    const double stamp = to_seconds(stamped.header.stamp);
    // A clock that was set back, or a bag that begins again, starts over.
    if (is_static || (!link.poses.empty() && stamp < link.poses.back().stamp - kKept))
      link.poses.clear();
    const auto after = std::ranges::upper_bound(link.poses, stamp, {}, &StampedPose::stamp);
    link.poses.insert(after, {stamp, *pose});
    const double oldest = link.poses.back().stamp - kKept;
    const auto kept = std::ranges::lower_bound(link.poses, oldest, {}, &StampedPose::stamp);
    link.poses.erase(link.poses.begin(),
                     std::max(kept, link.poses.end() - static_cast<std::ptrdiff_t>(
                                                           std::min(link.poses.size(), kPoses))));
  }
}

void Transforms::refuse(const std::string& child, const std::string& parent,
                        const Transform& transform) {
  if (refused_.size() >= kFrames && !refused_.contains(child)) return;
  refused_[child] = fmt::format(
      "the transform from {} to {} in /tf or /tf_static is no pose: {}. Correct it where it is "
      "published, and record again",
      child, parent, what_is_wrong(transform));
}

std::optional<Eigen::Isometry3d> Transforms::at(const Link& link, double stamp) {
  if (link.is_static) return link.poses.back().pose;
  const auto after = std::ranges::lower_bound(link.poses, stamp, {}, &StampedPose::stamp);
  if (after == link.poses.end()) return {};
  if (after->stamp == stamp) return after->pose;
  if (after == link.poses.begin()) return {};
  const StampedPose& before = *(after - 1);
  if (after->stamp - before.stamp > kWidestGap) return {};
  return between(before.pose, after->pose, (stamp - before.stamp) / (after->stamp - before.stamp));
}

std::vector<std::string> Transforms::ancestors(const std::string& frame) const {
  std::vector<std::string> found{frame};
  for (auto link = links_.find(frame); link != links_.end(); link = links_.find(found.back())) {
    found.push_back(link->second.parent);
  }
  return found;
}

std::optional<Eigen::Isometry3d> Transforms::climb(const std::string& frame,
                                                   const std::string& root, double stamp,
                                                   std::string* why) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::string here = frame; here != root;) {
    const Link& link = links_.at(here);
    const auto step = at(link, stamp);
    if (!step) {
      const auto refused = refused_.find(here);
      explain(why, refused != refused_.end()
                       ? refused->second
                       : fmt::format("/tf does not say where {} is in {} at that time", here,
                                     link.parent));
      return {};
    }
    pose = *step * pose;
    here = link.parent;
  }
  return pose;
}

std::optional<Eigen::Isometry3d> Transforms::find(const std::string& to, const std::string& from,
                                                  double stamp, std::string* why) const {
  const std::vector<std::string> up = ancestors(plain(from));
  const std::vector<std::string> target = ancestors(plain(to));
  const auto common = std::ranges::find_first_of(up, target);
  if (common == up.end()) {
    auto refused = refused_.find(up.back());
    if (refused == refused_.end()) refused = refused_.find(target.back());
    explain(why, refused == refused_.end() ? fmt::format("/tf connects no frame {} to {}", from, to)
                                           : refused->second);
    return {};
  }
  const auto one = climb(plain(from), *common, stamp, why);
  const auto other = climb(plain(to), *common, stamp, why);
  if (!one || !other) return {};
  return other->inverse() * *one;
}

}  // namespace palpate::message
