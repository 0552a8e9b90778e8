#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// ROS 2 message types (humble to rolling) as structs. each() lists a type's members by their names
/// in ROS: encoding and decoding (message/cdr.hpp) and the definition's text (message/schema.hpp)
/// come from that alone. kHash is the type's RIHS01 hash, of topics' types.
namespace palpate::message {

struct Time {
  static constexpr auto kName = "builtin_interfaces/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  static void each(auto& m, auto&& f) {
    f("sec", m.sec);
    f("nanosec", m.nanosec);
  }
};

struct Duration {
  static constexpr auto kName = "builtin_interfaces/Duration";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  static void each(auto& m, auto&& f) { Time::each(m, f); }
};

struct Header {
  static constexpr auto kName = "std_msgs/Header";
  Time stamp;
  std::string frame_id;

  static void each(auto& m, auto&& f) {
    f("stamp", m.stamp);
    f("frame_id", m.frame_id);
  }
};

struct ColorRGBA {
  static constexpr auto kName = "std_msgs/ColorRGBA";
  float r = 0;
  float g = 0;
  float b = 0;
  float a = 1;

  static void each(auto& m, auto&& f) {
    f("r", m.r);
    f("g", m.g);
    f("b", m.b);
    f("a", m.a);
  }
};

struct Bool {
  static constexpr auto kName = "std_msgs/Bool";
  static constexpr auto kHash = "feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9";
  bool data = false;

  static void each(auto& m, auto&& f) { f("data", m.data); }
};

struct Int32 {
  static constexpr auto kName = "std_msgs/Int32";
  static constexpr auto kHash = "b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb";
  std::int32_t data = 0;

  static void each(auto& m, auto&& f) { f("data", m.data); }
};

struct Float64 {
  static constexpr auto kName = "std_msgs/Float64";
  static constexpr auto kHash = "705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a";
  double data = 0;

  static void each(auto& m, auto&& f) { f("data", m.data); }
};

struct MultiArrayDimension {
  static constexpr auto kName = "std_msgs/MultiArrayDimension";
  std::string label;
  std::uint32_t size = 0;
  std::uint32_t stride = 0;

  static void each(auto& m, auto&& f) {
    f("label", m.label);
    f("size", m.size);
    f("stride", m.stride);
  }
};

struct MultiArrayLayout {
  static constexpr auto kName = "std_msgs/MultiArrayLayout";
  std::vector<MultiArrayDimension> dim;
  std::uint32_t data_offset = 0;

  static void each(auto& m, auto&& f) {
    f("dim", m.dim);
    f("data_offset", m.data_offset);
  }
};

struct Float64MultiArray {
  static constexpr auto kName = "std_msgs/Float64MultiArray";
  static constexpr auto kHash = "1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f";
  MultiArrayLayout layout;
  std::vector<double> data;

  static void each(auto& m, auto&& f) {
    f("layout", m.layout);
    f("data", m.data);
  }
};

struct Float32MultiArray {
  static constexpr auto kName = "std_msgs/Float32MultiArray";
  static constexpr auto kHash = "0599f6f85b4bfca379873a0b4375a0aca022156bd2d7021275d116ed1fa8bfe0";
  MultiArrayLayout layout;
  std::vector<float> data;

  static void each(auto& m, auto&& f) {
    f("layout", m.layout);
    f("data", m.data);
  }
};

struct Vector3 {
  static constexpr auto kName = "geometry_msgs/Vector3";
  static constexpr auto kHash = "cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d";
  double x = 0;
  double y = 0;
  double z = 0;

  static void each(auto& m, auto&& f) {
    f("x", m.x);
    f("y", m.y);
    f("z", m.z);
  }
};

struct Point {
  static constexpr auto kName = "geometry_msgs/Point";
  static constexpr auto kHash = "6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881";
  double x = 0;
  double y = 0;
  double z = 0;

  static void each(auto& m, auto&& f) { Vector3::each(m, f); }
};

struct Quaternion {
  static constexpr auto kName = "geometry_msgs/Quaternion";
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  static void each(auto& m, auto&& f) {
    f("x", m.x);
    f("y", m.y);
    f("z", m.z);
    f("w", m.w);
  }
};

struct Pose {
  static constexpr auto kName = "geometry_msgs/Pose";
  Point position;
  Quaternion orientation;

  static void each(auto& m, auto&& f) {
    f("position", m.position);
    f("orientation", m.orientation);
  }
};

struct Transform {
  static constexpr auto kName = "geometry_msgs/Transform";
  Vector3 translation;
  Quaternion rotation;

  static void each(auto& m, auto&& f) {
    f("translation", m.translation);
    f("rotation", m.rotation);
  }
};

struct Wrench {
  static constexpr auto kName = "geometry_msgs/Wrench";
  Vector3 force;
  Vector3 torque;

  static void each(auto& m, auto&& f) {
    f("force", m.force);
    f("torque", m.torque);
  }
};

struct Twist {
  static constexpr auto kName = "geometry_msgs/Twist";
  Vector3 linear;
  Vector3 angular;

  static void each(auto& m, auto&& f) {
    f("linear", m.linear);
    f("angular", m.angular);
  }
};

struct PoseStamped {
  static constexpr auto kName = "geometry_msgs/PoseStamped";
  static constexpr auto kHash = "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8";
  Header header;
  Pose pose;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("pose", m.pose);
  }
};

struct WrenchStamped {
  static constexpr auto kName = "geometry_msgs/WrenchStamped";
  static constexpr auto kHash = "8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77";
  Header header;
  Wrench wrench;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("wrench", m.wrench);
  }
};

struct TwistStamped {
  static constexpr auto kName = "geometry_msgs/TwistStamped";
  static constexpr auto kHash = "5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64";
  Header header;
  Twist twist;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("twist", m.twist);
  }
};

struct TransformStamped {
  static constexpr auto kName = "geometry_msgs/TransformStamped";
  Header header;
  std::string child_frame_id;
  Transform transform;

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("child_frame_id", m.child_frame_id);
    f("transform", m.transform);
  }
};

struct TFMessage {
  static constexpr auto kName = "tf2_msgs/TFMessage";
  static constexpr auto kHash = "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
  std::vector<TransformStamped> transforms;

  static void each(auto& m, auto&& f) { f("transforms", m.transforms); }
};

}  // namespace palpate::message
