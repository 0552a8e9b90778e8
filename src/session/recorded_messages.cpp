// Converts steps, frames and clouds to messages of a recording and back.
#include "session/recorded_messages.hpp"

#include <cstddef>

#include "message/transforms.hpp"

namespace palpate::session {

namespace {

std::vector<float> floats(const std::vector<Eigen::Vector3f>& vectors) {
  std::vector<float> values;
  for (const Eigen::Vector3f& v : vectors) values.insert(values.end(), {v.x(), v.y(), v.z()});
  return values;
}

std::vector<Eigen::Vector3f> vectors(const std::vector<float>& values) {
  std::vector<Eigen::Vector3f> made;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) made.emplace_back(values.data() + i);
  return made;
}

Eigen::Quaterniond rotation_of(const message::Quaternion& q) {
  return {q.w, q.x, q.y, q.z};
}

}  // namespace

message::Tick tick_of(const StepTrace& step, std::size_t sources) {
  const ServoState& state = step.state;
  const DeviceState& device = step.input.device;
  const SceneField::Found& found = step.input.found;
  const auto count = static_cast<std::ptrdiff_t>(sources);
  message::Tick tick;
  tick.step = state.step;
  tick.time = state.time;
  tick.dt = state.dt;
  tick.status = static_cast<std::uint8_t>(device.status);
  tick.device_time = device.time;
  tick.position = message::vector_of(device.position);
  tick.velocity = message::vector_of(device.velocity);
  const Eigen::Quaterniond& q = device.orientation;
  tick.orientation = {q.x(), q.y(), q.z(), q.w()};
  tick.buttons = device.buttons;
  tick.gripper = device.gripper;
  tick.paused = state.paused;
  tick.publications.assign(found.publications.begin(), found.publications.begin() + count);
  tick.least_radii.assign(found.least_radii.begin(), found.least_radii.begin() + count);
  const Contact& contact = state.contact;
  tick.hip = message::vector_of(state.hip);
  tick.force = message::vector_of(state.force);
  tick.proxy = message::vector_of(contact.proxy);
  tick.normal = message::vector_of(contact.normal);
  tick.stiffness = contact.stiffness;
  tick.touching = contact.touching;
  tick.sliding = contact.sliding;
  tick.iterations = contact.iterations;
  tick.evaluations = contact.evaluations;
  tick.patch_points = state.patch_points;
  tick.source = contact.source;
  tick.contact_notes = static_cast<std::uint32_t>(contact.notes);
  tick.field_notes = static_cast<std::uint32_t>(state.field_notes);
  tick.guard_notes = static_cast<std::uint32_t>(state.guard.notes);
  tick.guard_fault = static_cast<std::uint8_t>(state.guard.fault);
  tick.computing = state.timing.computing;
  return tick;
}

message::ToolStep tool_step_of(const ServoState& state, const DeviceState& device) {
  const Eigen::Quaterniond& q = state.tool.orientation;
  message::ToolStep step;
  step.step = state.step;
  step.orientation = {q.x(), q.y(), q.z(), q.w()};
  step.opening = state.tool.opening;
  step.force = message::vector_of(state.wrench.force);
  step.torque = message::vector_of(state.wrench.torque);
  step.grip = state.wrench.grip;
  step.angular_velocity = message::vector_of(device.angular_velocity);
  step.sent_torque = message::vector_of(state.torque);
  step.sent_grip = state.grip;
  return step;
}

ServoState state_of(const message::Tick& tick, const std::optional<message::ToolStep>& tool,
                    const ServoOptions& options) {
  const Workspace& workspace = options.workspace;
  ServoState state;
  state.step = tick.step;
  state.time = tick.time;
  state.dt = tick.dt;
  state.hip = message::eigen(tick.hip);
  state.velocity = workspace.velocity_to_world(message::eigen(tick.velocity));
  state.orientation = workspace.orientation_to_world(rotation_of(tick.orientation));
  state.gripper = tick.gripper;
  Contact& contact = state.contact;
  contact.proxy = message::eigen(tick.proxy);
  contact.normal = message::eigen(tick.normal);
  contact.stiffness = tick.stiffness;
  contact.touching = tick.touching;
  contact.sliding = tick.sliding;
  contact.iterations = tick.iterations;
  contact.evaluations = tick.evaluations;
  contact.source = tick.source;
  contact.notes = static_cast<ContactNote>(tick.contact_notes);
  state.force = message::eigen(tick.force);
  state.guard.notes = static_cast<GuardNote>(tick.guard_notes);
  state.guard.fault = static_cast<Guard::Fault>(tick.guard_fault);
  state.field_notes = static_cast<FieldNote>(tick.field_notes);
  state.device = static_cast<DeviceState::Status>(tick.status);
  state.buttons = tick.buttons;
  state.patch_points = tick.patch_points;
  state.paused = tick.paused;
  state.clutched = options.clutch_button && ((tick.buttons >> *options.clutch_button) & 1u) != 0;
  state.timing.computing = tick.computing;
  state.tool = {contact.proxy, state.orientation, workspace.scale * state.gripper};
  if (!tool) return state;
  state.tool = {contact.proxy, rotation_of(tool->orientation), tool->opening};
  state.wrench = {message::eigen(tool->force), message::eigen(tool->torque), tool->grip};
  state.torque = message::eigen(tool->sent_torque);
  state.grip = tool->sent_grip;
  return state;
}

message::Cloud recorded(const PointCloud& cloud) {
  message::Cloud made;
  made.origin = message::vector_of(cloud.origin);
  made.positions = floats(cloud.positions);
  made.normals = floats(cloud.normals);
  made.intensities = cloud.intensities;
  if (const auto& from = cloud.viewpoint) made.viewpoint = {from->x(), from->y(), from->z()};
  made.width = cloud.width;
  made.height = cloud.height;
  made.pixels = cloud.pixels;
  return made;
}

PointCloud cloud_of(const message::Cloud& message) {
  PointCloud cloud;
  cloud.origin = message::eigen(message.origin);
  cloud.positions = vectors(message.positions);
  cloud.normals = vectors(message.normals);
  cloud.intensities = message.intensities;
  if (message.viewpoint.size() == 3) cloud.viewpoint.emplace(message.viewpoint.data());
  cloud.width = message.width;
  cloud.height = message.height;
  cloud.pixels = message.pixels;
  return cloud;
}

std::vector<double> rows_of(const Eigen::Isometry3d& pose) {
  std::vector<double> values;
  for (int i = 0; i < 12; ++i) values.push_back(pose.matrix()(i / 4, i % 4));
  return values;
}

DepthFrame without_colors(const DepthFrame& frame) {
  DepthFrame kept;
  kept.camera = frame.camera;
  kept.stamp = frame.stamp;
  kept.T_world_sensor = frame.T_world_sensor;
  kept.depth = frame.depth;
  kept.cloud = frame.cloud;
  return kept;
}

}  // namespace palpate::session
