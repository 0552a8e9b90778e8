// What each supported ROS node of a device publishes and takes, and how its axes lie.
#include "device/ros_link.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>

#include "message/sensor_types.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using namespace message;
using Eigen::Vector3d;
using palpate::Wrench;  // not the message's

// Force Dimension's: x towards the operator, y to the right.
const Eigen::Matrix3d kForceDimension =
    (Eigen::Matrix3d() << 0, 1, 0, -1, 0, 0, 0, 0, 1).finished();

void put_pose(const PoseStamped& message, RosReading& reading) {
  const auto pose = isometry(message.pose);
  if (!pose) throw Error("a pose that is not one: not finite, or a quaternion not of unit length");
  reading.state.position = pose->translation();
  reading.state.orientation = Eigen::Quaterniond(pose->linear());
  const double stamp = to_seconds(message.header.stamp);
  if (stamp > 0) reading.stamp = stamp;
}

void put_velocity(const TwistStamped& message, RosReading& reading) {
  reading.state.velocity = eigen(message.twist.linear);
  reading.has_velocity = true;
}

void put_button(std::uint32_t bit, bool down, RosReading& reading) {
  reading.state.buttons = (reading.state.buttons & ~(1U << bit)) | (down ? 1U << bit : 0U);
}

void put_wrench(const Wrench& wrench, WrenchStamped& message) {
  message.wrench = {vector_of(wrench.force), vector_of(wrench.torque)};
}

void wrench_to(RosLink& link, const std::string& topic) {
  link.force_to<WrenchStamped>(topic, put_wrench);
  link.takes_torque = true;
}

// The presets: docs/ros2.md names the packages.
void crtk(RosLink& link, const DeviceName& name) {
  const std::string ns = name.option("ns", "/arm");
  link.axes = {kForceDimension, kForceDimension};
  link.on_pose<PoseStamped>(ns + "/measured_cp", put_pose);
  link.on<TwistStamped>(ns + "/measured_cv", put_velocity);
  link.on<JointState>(ns + "/gripper/measured_js",
                      [](const JointState& message, RosReading& reading) {
                        if (!message.position.empty())
                          reading.state.gripper = message.position.front();
                      });
  wrench_to(link, ns + "/body/servo_cf");
}

// The parameter transform_rotation of fd's ee_pose_broadcaster: radians about z, y and x, as its
// package has it unless they are given.
Eigen::Matrix3d broadcast_rotation(const DeviceName& name) {
  const std::string text = name.option("rotation", "0/1.5707/0");
  Vector3d angles = Vector3d::Zero();
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const auto [stop, error] = std::from_chars(at, end, angles[i]);
    good = good && error == std::errc{} && (i < 2 ? stop < end && *stop == '/' : stop == end);
    at = std::min(stop + 1, end);
  }
  if (!good || !angles.allFinite()) {
    throw Error(fmt::format(
        "device ros:fd: rotation={} is not three angles; write what transform_rotation of its "
        "ee_pose_broadcaster is, as in rotation=0/1.5707/0",
        text));
  }
  return (Eigen::AngleAxisd(angles.x(), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.z(), Vector3d::UnitX()))
      .toRotationMatrix();
}

// Count of numbers that the effort controller takes: forces, of devices with motors at the wrist
// torques, then the gripper's, whose opening no message tells.
std::size_t joints_of(const DeviceName& name) {
  const std::string text = name.option("joints", "3");
  if (text.size() == 1 && text[0] >= '3' && text[0] <= '7')
    return static_cast<std::size_t>(text[0] - '0');
  throw Error(fmt::format("device ros:fd: joints={} is not a number from 3 to 7", text));
}

void fd(RosLink& link, const DeviceName& name) {
  const std::string ns = name.option("ns", "/fd");
  // Its broadcaster turns poses; forces are in the device's own axes.
  link.axes = {kForceDimension * broadcast_rotation(name).transpose(), kForceDimension};
  link.on_pose<PoseStamped>(ns + "/ee_pose", put_pose);
  link.on_buttons<Bool>(ns + "/button_state", [](const Bool& message, RosReading& reading) {
    put_button(0, message.data, reading);
  });
  const std::size_t joints = joints_of(name);
  link.takes_torque = joints >= 6;
  link.force_to<Float64MultiArray>(
      ns + "/fd_controller/commands",
      [joints, torque = link.takes_torque](const Wrench& wrench, Float64MultiArray& message) {
        message.data.assign(wrench.force.data(), wrench.force.data() + 3);
        if (torque)
          message.data.insert(message.data.end(), wrench.torque.data(), wrench.torque.data() + 3);
        message.data.resize(joints, 0);
      });
}

void ros_force_dimension(RosLink& link, const DeviceName& name) {
  const std::string ns = name.option("ns", "/robot");
  link.axes = {kForceDimension, kForceDimension};
  link.on_pose<Point>(ns + "/feedback/position", [](const Point& message, RosReading& reading) {
    reading.state.position = {message.x, message.y, message.z};
  });
  link.on<Vector3>(ns + "/feedback/velocity", [](const Vector3& message, RosReading& reading) {
    reading.state.velocity = eigen(message);
    reading.has_velocity = true;
  });
  link.on_buttons<Int32>(ns + "/feedback/button", [](const Int32& message, RosReading& reading) {
    put_button(0, message.data != 0, reading);
  });
  link.on<Float64>(ns + "/feedback/gripper_gap", [](const Float64& message, RosReading& reading) {
    reading.state.gripper = message.data;
  });
  link.force_to<Vector3>(ns + "/command/force", [](const Wrench& wrench, Vector3& message) {
    message = vector_of(wrench.force);
  });
}

void omni(RosLink& link, const DeviceName& name) {
  const std::string ns = name.option("ns", "/phantom");
  link.on_pose<PoseStamped>(ns + "/pose", put_pose);
  link.on_buttons<OmniButtonEvent>(ns + "/button",
                                   [](const OmniButtonEvent& message, RosReading& reading) {
                                     put_button(0, message.grey_button != 0, reading);
                                     put_button(1, message.white_button != 0, reading);
                                   });
  link.force_to<OmniFeedback>(
      ns + "/force_feedback",
      [](const Wrench& wrench, OmniFeedback& message) { message.force = vector_of(wrench.force); });
}

void haply_isir(RosLink& link, const DeviceName& name) {
  const std::string ns = name.option("ns", "");
  link.on_pose<Float32MultiArray>(ns + "/haply_pos_vel", [](const Float32MultiArray& message,
                                                            RosReading& reading) {
    if (message.data.size() < 6)
      throw Error(
          fmt::format("{} numbers where a position and a velocity have six", message.data.size()));
    reading.state.position = Eigen::Map<const Eigen::Vector3f>(message.data.data()).cast<double>();
    reading.state.velocity =
        Eigen::Map<const Eigen::Vector3f>(message.data.data() + 3).cast<double>();
    reading.has_velocity = true;
  });
  link.force_to<Float32MultiArray>(ns + "/haply_forces",
                                   [](const Wrench& wrench, Float32MultiArray& message) {
                                     const Eigen::Vector3f numbers = wrench.force.cast<float>();
                                     message.data.assign(numbers.data(), numbers.data() + 3);
                                   });
}

void generic(RosLink& link, const DeviceName& name) {
  const std::string pose = name.option("pose");
  const std::string wrench = name.option("wrench");
  if (pose.empty() || wrench.empty()) {
    throw Error("device ros:generic needs the topics: ros:generic,pose=TOPIC,wrench=TOPIC");
  }
  link.on_pose<PoseStamped>(pose, put_pose);
  if (const std::string twist = name.option("twist"); !twist.empty())
    link.on<TwistStamped>(twist, put_velocity);
  if (const std::string joy = name.option("joy"); !joy.empty()) {
    link.on_buttons<Joy>(joy, [](const Joy& message, RosReading& reading) {
      for (std::uint32_t i = 0; i < std::min<std::size_t>(message.buttons.size(), 32); ++i) {
        put_button(i, message.buttons[i] != 0, reading);
      }
    });
  }
  wrench_to(link, wrench);
}

struct RosPreset {
  std::string_view name;
  void (*apply)(RosLink&, const DeviceName&);
};
constexpr std::array<RosPreset, 6> kPresets = {{{"crtk", crtk},
                                                {"fd", fd},
                                                {"ros_force_dimension", ros_force_dimension},
                                                {"omni", omni},
                                                {"haply_isir", haply_isir},
                                                {"generic", generic}}};

}  // namespace

void set_up(RosLink& link, const DeviceName& name) {
  const auto preset = std::ranges::find(kPresets, name.device, &RosPreset::name);
  if (preset == kPresets.end()) {
    throw Error(fmt::format(
        "device ros:{}: no such preset; there are crtk, fd, ros_force_dimension, omni, haply_isir "
        "and generic",
        name.device));
  }
  preset->apply(link, name);
}

}  // namespace palpate::device
