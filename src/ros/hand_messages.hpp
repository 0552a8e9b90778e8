#pragma once

#include <string>

#include "message/display_types.hpp"
#include "palpate/ros/bridge.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"

/// Turns a run's states into ROS 2 messages, for the bridge and for recordings.
/// `header`: stamp and the name of the world frame. Any thread.
namespace palpate::ros {

/// Poses of hand and proxy, that of a tool which turns as far as the surface lets it.
[[nodiscard]] message::PoseStamped hand_pose(const message::Header& header,
                                             const ServoState& state);
[[nodiscard]] message::PoseStamped proxy_pose(const message::Header& header,
                                              const ServoState& state);
[[nodiscard]] message::TwistStamped hand_twist(const message::Header& header,
                                               const ServoState& state);
/// Force and torque on the hand, about the tool's handle, as the device was given them.
[[nodiscard]] message::WrenchStamped hand_wrench(const message::Header& header,
                                                 const ServoState& state);
/// The first eight buttons; axis 0 is the gripper's opening, m.
[[nodiscard]] message::Joy hand_joy(const message::Header& header, const ServoState& state);
/// The proxy's frame, child "palpate_NAME".
[[nodiscard]] message::TransformStamped proxy_frame(const message::Header& header,
                                                    const std::string& name,
                                                    const ServoState& state);

/// Hand, proxy, tangent plane and force arrow of hand `index`, whose sizes go with `extent` (m) of
/// what is touched.
void add_markers(const message::Header& header, const ServoState& state, int index, double extent,
                 message::MarkerArray& markers);

/// Up to `most` points of a source's newest surface, evenly among all, with normals; empty where it
/// has none.
[[nodiscard]] message::PointCloud2 surface_message(const message::Header& header,
                                                   const Source& source, std::size_t most);

/// A hand's timing and guard; `last`: of the last second.
[[nodiscard]] message::DiagnosticStatus hand_status(const std::string& name,
                                                    const ServoState& state,
                                                    const StepDurations& last);
/// A stream's phase, ages and drops.
[[nodiscard]] message::DiagnosticStatus stream_status(const StreamState& state);
/// Reports whether a robot follows, and how long it waited for each reason.
[[nodiscard]] message::DiagnosticStatus robot_status(const RosBridge::RobotState& state);

}  // namespace palpate::ros
