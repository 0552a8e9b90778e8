#pragma once

#include "message/geometry_types.hpp"

/// palpate's own types, whose definitions travel in its recordings (docs/bags.md).
namespace palpate::message {

/// A servo's step: the device's state, what the field found of each source, and what was felt.
struct Tick {
  static constexpr auto kName = "palpate_msgs/Tick";
  static constexpr auto kHash = "";
  Header header;
  std::uint64_t step = 0;
  double time = 0;  // s, of the run's clock
  double dt = 0;
  std::uint8_t status = 0;  // of the device: ok, silent, finished, failed
  double device_time = 0;   // s
  Vector3 position;         // the device's frame, m
  Vector3 velocity;         // m/s
  Quaternion orientation;
  std::uint32_t buttons = 0;
  double gripper = 0;  // m
  bool paused = false;
  std::vector<std::uint64_t> publications;  // of each source, the last that was taken
  std::vector<double> least_radii;          // of each source's supports, m
  Vector3 hip;                              // where the hand has the tool, world, m
  Vector3 force;                            // behind the guard, world, N
  Vector3 proxy;                            // m
  Vector3 normal;                           // of the contact
  double stiffness = 0;                     // of all springs in the force, N/m
  bool touching = false;
  bool sliding = false;
  std::int32_t iterations = 0;
  std::int32_t evaluations = 0;
  std::uint64_t patch_points = 0;
  std::int32_t source = -1;  // that is touched
  std::uint32_t contact_notes = 0;
  std::uint32_t field_notes = 0;
  std::uint32_t guard_notes = 0;
  std::uint8_t guard_fault = 0;
  double computing = 0;  // s; not a number: not measured

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("step", m.step);
    f("time", m.time);
    f("dt", m.dt);
    f("status", m.status);
    f("device_time", m.device_time);
    f("position", m.position);
    f("velocity", m.velocity);
    f("orientation", m.orientation);
    f("buttons", m.buttons);
    f("gripper", m.gripper);
    f("paused", m.paused);
    f("publications", m.publications);
    f("least_radii", m.least_radii);
    f("hip", m.hip);
    f("force", m.force);
    f("proxy", m.proxy);
    f("normal", m.normal);
    f("stiffness", m.stiffness);
    f("touching", m.touching);
    f("sliding", m.sliding);
    f("iterations", m.iterations);
    f("evaluations", m.evaluations);
    f("patch_points", m.patch_points);
    f("source", m.source);
    f("contact_notes", m.contact_notes);
    f("field_notes", m.field_notes);
    f("guard_notes", m.guard_notes);
    f("guard_fault", m.guard_fault);
    f("computing", m.computing);
  }
};

/// What a step of a tool that turns has beside its Tick, which follows.
struct ToolStep {
  static constexpr auto kName = "palpate_msgs/ToolStep";
  static constexpr auto kHash = "";
  Header header;
  std::uint64_t step = 0;
  Quaternion orientation;    // of the tool, outside of the surface; its handle is the proxy
  double opening = 0;        // of its fingers, m
  Vector3 force;             // of the tool's proxy, before the guard, N
  Vector3 torque;            // about the handle, N m
  double grip = 0;           // on the opening, N
  Vector3 angular_velocity;  // of the device, as it was read, rad/s
  Vector3 sent_torque;       // what the guard let through, N m
  double sent_grip = 0;      // the same, N

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("step", m.step);
    f("orientation", m.orientation);
    f("opening", m.opening);
    f("force", m.force);
    f("torque", m.torque);
    f("grip", m.grip);
    f("angular_velocity", m.angular_velocity);
    f("sent_torque", m.sent_torque);
    f("sent_grip", m.sent_grip);
  }
};

/// Fate of a camera's frame, and what that depended on besides the frame.
struct FrameUse {
  static constexpr auto kName = "palpate_msgs/FrameUse";
  static constexpr auto kHash = "";
  Header header;
  std::string kind;           // "image", "cloud"; "end": the last surface was kept
  std::string why_not;        // it became no surface; empty: it did
  bool dropped = false;       // preparation did not look at it
  double stamp = 0;           // s, of the run's clock
  double start = 0;           // when the surface began, s
  std::vector<double> pose;   // of the sensor, three rows of four; empty: where the source stands
  std::vector<double> reach;  // balls where tools could be: x, y, z, radius each, m
  std::uint64_t publication = 0;  // of the source, with this one
  std::string options;            // of the source from here on, JSON; empty: as before
  bool gap = false;               // frames just before it were not recorded

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("kind", m.kind);
    f("why_not", m.why_not);
    f("dropped", m.dropped);
    f("stamp", m.stamp);
    f("start", m.start);
    f("pose", m.pose);
    f("reach", m.reach);
    f("publication", m.publication);
    f("options", m.options);
    f("gap", m.gap);
  }
};

/// Something that was changed before a step.
struct Change {
  static constexpr auto kName = "palpate_msgs/Change";
  static constexpr auto kHash = "";
  Header header;
  std::uint64_t step = 0;  // the first that it holds for
  std::string what;        // "contact", "field", "reset", "force"
  std::string value;       // JSON

  static void each(auto& m, auto&& f) {
    f("header", m.header);
    f("step", m.step);
    f("what", m.what);
    f("value", m.value);
  }
};

/// A PointCloud as it is, but for colours.
struct Cloud {
  static constexpr auto kName = "palpate_msgs/Cloud";
  static constexpr auto kHash = "";
  Vector3 origin;
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> intensities;
  std::vector<double> viewpoint;  // empty: unknown
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::vector<std::uint32_t> pixels;

  static void each(auto& m, auto&& f) {
    f("origin", m.origin);
    f("positions", m.positions);
    f("normals", m.normals);
    f("intensities", m.intensities);
    f("viewpoint", m.viewpoint);
    f("width", m.width);
    f("height", m.height);
    f("pixels", m.pixels);
  }
};

}  // namespace palpate::message
