#include "apps/palpate/sources/load.hpp"

#include <fmt/format.h>

#include <chrono>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/read_depth.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/sensor/open_camera.hpp"

namespace palpate::app {

namespace {

CloudFile make_synthetic(const std::string& name, double scale) {
  CloudFile file;
  file.cloud = suggesting(name, synthetic_names(), [&] { return synthetic_cloud(name); });
  file.format = "made by palpate";
  file.declared = file.cloud.size();
  const auto factor = static_cast<float>(scale);
  for (Eigen::Vector3f& p : file.cloud.positions) p *= factor;
  if (file.cloud.viewpoint) *file.cloud.viewpoint *= scale;
  return file;
}

CloudFile read(const CloudArgument& argument, const ReadOptions& options) {
  if (argument.path.starts_with(kSynthetic)) {
    return make_synthetic(argument.path.substr(kSynthetic.size()), options.scale);
  }
  ReadOptions shown = options;
  Progress progress(fmt::format("reading {}", argument.path));
  shown.progress = [&](double done) { progress.update(done); };
  return read_cloud_file(argument.path, shown);
}

// A camera whose frames say where they were taken in a frame of its own (a recording with poses):
// puts that frame where the user wants it in the world. Frames without a pose are left as they
// are: the source's pose holds for them.
class PosedCamera final : public DepthCamera {
 public:
  PosedCamera(std::unique_ptr<DepthCamera> camera, const Eigen::Isometry3d& T_world_recording)
      : camera_(std::move(camera)), T_world_recording_(T_world_recording) {}

  [[nodiscard]] const CameraInfo& info() const noexcept override { return camera_->info(); }
  void begin(double start) override { camera_->begin(start); }
  [[nodiscard]] CameraStatus read(DepthFrame& frame, double timeout) override {
    const CameraStatus status = camera_->read(frame, timeout);
    if (status == CameraStatus::frame && frame.T_world_sensor) {
      frame.T_world_sensor = T_world_recording_ * *frame.T_world_sensor;
    }
    return status;
  }
  [[nodiscard]] std::string reason() const override { return camera_->reason(); }

 private:
  std::unique_ptr<DepthCamera> camera_;
  Eigen::Isometry3d T_world_recording_;
};

// s; a sensor's motor and lamp may take one or two to start.
constexpr double kPatience = 5;
constexpr double kAnswerWait = 0.1;  // s, for one answer
// Answers of a camera that waits for nothing.
constexpr int kAnswerTries = 100;

std::unique_ptr<DepthCamera> open(const SourcePlan& source, const Clock* clock) {
  const std::string& path = source.argument.path;
  const std::string name = path.starts_with(kCamera) ? path.substr(kCamera.size()) : path;
  return open_camera(name, {.clock = clock, .loop = source.loop});
}

}  // namespace

LoadedCloud load(const CloudArgument& argument, const ReadOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedCloud result{argument, read(argument, options), 0};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.file.cloud.empty()) {
    throw Error(
        fmt::format("{} holds no valid point ({} announced, {} dropped as invalid): there is "
                    "nothing to touch",
                    argument.path, result.file.declared, result.file.dropped));
  }
  return result;
}

DepthFrame load_depth_image(const std::string& path, const ReadOptions& options) {
  if (!options.intrinsics) {
    throw Error(fmt::format(
        "{} is a depth image, and the camera is not known; give its intrinsics in pixels "
        "(--intrinsics fx,fy,cx,cy; a sequence.json or camera file beside the image may hold them) "
        "and the metres of one depth step (--depth-unit)",
        path));
  }
  ReadDepthOptions read;
  read.camera.pinhole = *options.intrinsics;
  read.depth_unit = options.depth_unit * options.scale;
  return read_depth_frame(path, read);
}

std::unique_ptr<DepthCamera> open_stream(const SourcePlan& source, const Clock* clock) {
  std::unique_ptr<DepthCamera> camera = open(source, clock);
  if (clock == nullptr && camera->info().paces) {
    throw Error(
        fmt::format("{} keeps its own time; leave --simulated-time out, or play a "
                    "recording of it (sequence:FOLDER)",
                    source.argument.path));
  }
  const Eigen::Isometry3d& pose = source.options.T_world_sensor;
  if (pose.isApprox(Eigen::Isometry3d::Identity(), 0)) return camera;
  return std::make_unique<PosedCamera>(std::move(camera), pose);
}

std::unique_ptr<DepthCamera> open_stream_at_any_pace(const SourcePlan& source) {
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

PointCloud cloud_of(const DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  PointCloud cloud;
  cloud.viewpoint = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    const auto width = static_cast<std::size_t>(frame.camera.width);
    const double x = (static_cast<double>(i % width) - p.cx) * z / p.fx;
    const double y = (static_cast<double>(i / width) - p.cy) * z / p.fy;
    cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  }
  return cloud;
}

}  // namespace palpate::app
