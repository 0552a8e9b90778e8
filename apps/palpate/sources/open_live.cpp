#include "apps/palpate/sources/open_live.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/sources/posed_camera.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/open_camera.hpp"

namespace palpate::app {

namespace {

// s; a sensor's motor and lamp may take one or two to start.
constexpr double kPatience = 5;
constexpr double kAnswerWait = 0.1;  // s, for one answer
// Answers of a camera that waits for nothing.
constexpr int kAnswerTries = 100;

std::unique_ptr<DepthCamera> open(const ChosenSource& source, const Clock* clock) {
  const std::string& path = source.argument.path;
  const std::string name = path.starts_with(kCamera) ? path.substr(kCamera.size()) : path;
  return open_camera(name, {.clock = clock, .loop = source.choices.loop});
}

}  // namespace

std::unique_ptr<DepthCamera> open_live(const ChosenSource& source, const Clock* clock) {
  std::unique_ptr<DepthCamera> camera = open(source, clock);
  if (clock == nullptr && camera->info().paces) {
    throw Error(
        fmt::format("{} keeps its own time; leave --simulated-time out, or play a "
                    "recording of it (sequence:FOLDER)",
                    source.argument.path));
  }
  if (source.pose.isApprox(Eigen::Isometry3d::Identity(), 0)) return camera;
  return std::make_unique<PosedCamera>(std::move(camera), source.pose);
}

std::unique_ptr<DepthCamera> open_live_at_any_pace(const ChosenSource& source) {
  return open(source, nullptr);
}

DepthFrame first_frame(DepthCamera& camera) {
  const Waiting waiting(fmt::format("waiting for the first frame of {}", camera.info().name));
  DepthFrame frame;
  std::string problem = "no frame came";
  const int tries = camera.info().paces ? static_cast<int>(kPatience / kAnswerWait) : kAnswerTries;
  for (int i = 0; i < tries; ++i) {
    const CameraStatus status = camera.read(frame, kAnswerWait);
    if (status == CameraStatus::frame) return frame;
    if (!camera.reason().empty()) problem = camera.reason();
    if (status == CameraStatus::ended) break;
  }
  throw Error(fmt::format("{} gave no frame: {}", camera.info().name, problem));
}

}  // namespace palpate::app
