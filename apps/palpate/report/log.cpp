// Writes the CSV log of a run.
#include "apps/palpate/report/log.hpp"

#include <iterator>
#include <string_view>

#include "apps/palpate/cli/output.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kFlush = 1 << 16;  // bytes a write; judgement

}  // namespace

TouchLog::TouchLog(const std::string& path, bool turns)
    : file_(path, OutputFile::Unfinished::stays), turns_(turns) {
  buffer_.reserve(kFlush + 1024);
}

TouchLog::~TouchLog() {
  try {
    if (problem_.empty() && buffer_.size() > 0) flush();
  } catch (const Error&) {  // nobody is left to report to
  }
}

void TouchLog::flush() {
  try {
    file_.write({buffer_.data(), buffer_.size()});
  } catch (const Error& error) {
    problem_ = error.what();
    throw;
  }
  buffer_.clear();
}

void TouchLog::begin(bool orientation, bool gripper) {
  buffer_.append(std::string_view(
      "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,fx,fy,fz,us,touching,sliding,nx,ny,nz,"
      "stiffness,iterations,evaluations,patch_points,source,notes,field_notes"));
  if (orientation) buffer_.append(std::string_view(",qx,qy,qz,qw"));
  if (gripper) buffer_.append(std::string_view(",gripper"));
  if (turns_) {
    buffer_.append(std::string_view(
        ",tool_qx,tool_qy,tool_qz,tool_qw,tool_opening,torque_x,torque_y,torque_z,grip"));
  }
  buffer_.push_back('\n');
  begun_ = true;
}

void TouchLog::add(const ServoState& step, const DeviceInfo& device, double scale) {
  if (!problem_.empty()) return;
  const bool orientation = device.has_orientation || turns_;
  const bool gripper = device.has_gripper || turns_;
  if (!begun_) begin(orientation, gripper);
  const Contact& c = step.contact;
  const Eigen::Vector3d& h = step.hip;
  const Eigen::Vector3d& f = step.force;
  fmt::format_to(std::back_inserter(buffer_),
                 "{},{},{},{},{},{},{},{},{},{},{:.3f},{},{},{},{},{},", step.time, h.x(), h.y(),
                 h.z(), c.proxy.x(), c.proxy.y(), c.proxy.z(), f.x(), f.y(), f.z(),
                 1e6 * step.timing.computing, c.touching ? 1 : 0, c.sliding ? 1 : 0, c.normal.x(),
                 c.normal.y(), c.normal.z());
  fmt::format_to(std::back_inserter(buffer_), "{},{},{},{},{},{},{}", c.stiffness, c.iterations,
                 c.evaluations, step.patch_points, c.source, static_cast<unsigned>(c.notes),
                 static_cast<unsigned>(step.field_notes));
  if (orientation) {
    const Eigen::Quaterniond& q = step.orientation;
    fmt::format_to(std::back_inserter(buffer_), ",{},{},{},{}", q.x(), q.y(), q.z(), q.w());
  }
  if (gripper) fmt::format_to(std::back_inserter(buffer_), ",{}", scale * step.gripper);
  if (turns_) {
    const Eigen::Quaterniond& q = step.tool.orientation;
    const Eigen::Vector3d& torque = step.wrench.torque;
    fmt::format_to(std::back_inserter(buffer_), ",{},{},{},{},{},{},{},{},{}", q.x(), q.y(), q.z(),
                   q.w(), step.tool.opening, torque.x(), torque.y(), torque.z(), step.wrench.grip);
  }
  buffer_.push_back('\n');
  if (buffer_.size() >= kFlush) flush();
}

void TouchLog::close() {
  if (!problem_.empty()) throw Error(problem_);
  if (!begun_) begin(turns_, turns_);
  flush();
  file_.close();
}

}  // namespace palpate::app
