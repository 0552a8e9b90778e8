#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "message/palpate_types.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/servo/servo.hpp"
#include "servo/step_trace.hpp"

namespace palpate::session {

/// Names that a recording's parts go by.
inline constexpr const char* kSetupName = "setup.json";
inline constexpr const char* kSetupKind = "palpate recording 3";
/// With a hand that holds a tool that turns: an older program would take it for a point.
inline constexpr const char* kToolSetupKind = "palpate recording 4";
[[nodiscard]] inline std::string surface_name(std::size_t source) {
  return fmt::format("surface-{}.cdr", source);
}

/// A frame of a source, and what became of it.
struct RecordedFrame {
  std::size_t source = 0;
  DepthFrame frame;  ///< of kinds "image" and "cloud"
  message::FrameUse use;
};

/// A step of a run of `sources` as a recording holds it.
[[nodiscard]] message::Tick tick_of(const StepTrace& step, std::size_t sources);

/// What such a step of a tool that turns has beside that.
[[nodiscard]] message::ToolStep tool_step_of(const ServoState& state, const DeviceState& device);

/// The servo's state in that step; `tool`: of a tool that turns. `options`: of its servo. Not
/// recorded: the guard's counts and energy, the proxy's own force and drift, the clutch's shift,
/// lateness.
[[nodiscard]] ServoState state_of(const message::Tick& tick,
                                  const std::optional<message::ToolStep>& tool,
                                  const ServoOptions& options);

/// A pose's first three rows, as messages hold it.
[[nodiscard]] std::vector<double> rows_of(const Eigen::Isometry3d& pose);

/// The frame without what no surface depends on.
[[nodiscard]] DepthFrame without_colors(const DepthFrame& frame);

/// A cloud as a recording holds it, and back.
[[nodiscard]] message::Cloud recorded(const PointCloud& cloud);
[[nodiscard]] PointCloud cloud_of(const message::Cloud& message);

}  // namespace palpate::session
