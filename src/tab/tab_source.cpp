// Makes a surface of a cloud or of a simulated camera's frames.
#include "tab/tab_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "sensor/stream_statistics.hpp"
#include "session/frames.hpp"
#include "session/length_unit.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate::tab {
namespace {

constexpr std::string_view kSynthetic = "synthetic:";
constexpr std::string_view kCamera = "camera:simulated";

// A second of the desk takes 0.18 s of a tab's one thread so; with frames of 640 x 480 pixels 0.31
// s, and 191 MB for 64 (measured: Node 20).
constexpr std::string_view kFrames = "width=320,rate=15";

// s; the first frame is there.
constexpr double kFirstFrame = 0.05;

// Why there is no surface after the first frame.
std::string lack_of(const SimulatedStream& stream) {
  const std::string problem = stream.state().problem;
  return problem.empty() ? fmt::format("no frame within {:g} s", kFirstFrame) : problem;
}

// The name that the program gives it: without what its format adds.
std::string name_of_file(const std::string& name) {
  std::filesystem::path path(name);
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

// `rest`: ":SCENE,KEY=VALUE", of which each part may be missing.
Touched camera_of(std::string_view rest) {
  if (!rest.empty()) rest.remove_prefix(1);
  const std::size_t comma = std::min(rest.find(','), rest.size());
  const std::string_view scene = rest.substr(0, comma);
  const std::string wanted = fmt::format("{},{}{}", scene, kFrames, rest.substr(comma));
  return {.name = std::string(scene.empty() ? "table" : scene),
          .camera = open_simulated(wanted, nullptr)};
}

}  // namespace

Touched simulated(const std::string& name) {
  const std::string_view given = name;
  if (given.starts_with(kCamera)) {
    const std::string_view rest = given.substr(kCamera.size());
    if (rest.empty() || rest.front() == ':') return camera_of(rest);
  }
  std::string plain(given.starts_with(kSynthetic) ? given.substr(kSynthetic.size()) : given);
  PointCloud cloud = synthetic_cloud(plain);
  return {std::move(plain), std::move(cloud)};
}

Touched of_file(std::span<const std::byte> bytes, const std::string& name, double unit) {
  ReadOptions reading;
  if (unit > 0) reading.scale = unit;
  CloudFile file = read_cloud_bytes(bytes, name, reading);
  std::optional<session::UnitQuestion> question;
  if (unit == 0) {
    unit = file.unit.plan;
    const Box core = session::core_of(file.cloud);
    const double likely = session::units_of(file, core).metres;
    if (likely > 0) question = {core, likely};
  }
  std::string shown = name_of_file(name);
  session::Setting setting = session::unit_setting(shown, unit, question);
  return {.name = std::move(shown), .cloud = std::move(file.cloud), .unit = std::move(setting)};
}

TabSource::TabSource(Touched touched)
    : touched_(std::move(touched)), source_(added()), first_(source_.options()) {
  preparation_.policy = first_.policy.policy;
  preparation_.history = first_.policy.history;
  preparation_.voxel = first_.prepare.voxel;
  initial_ = preparation_;
  if (touched_.camera == nullptr) return;
  const Stream::Sink push = sensor::sink_of(source_);
  stream_.emplace(
      *touched_.camera, name(),
      [this, push](const DepthFrame& frame, const Source::StartTime& start) {
        lens_ = frame.camera;
        if (frame.T_world_sensor) source_.set_pose(*frame.T_world_sensor);
        push(frame, start);
      },
      SimulatedStreamOptions{}, [this] { source_.keep(); });
  stream_->advance(kFirstFrame);
  if (!source_.points()) throw Error(fmt::format("{}: {}", name(), lack_of(*stream_)));
}

Source& TabSource::added() {
  if (touched_.camera == nullptr) return scene_.add(touched_.name, touched_.cloud);
  return scene_.add(touched_.name);
}

session::ViewScope TabSource::scope(double scale, const std::vector<Servo*>& servos) const {
  session::ViewScope scope = session::scope_of(scene_, scale, servos);
  scope.lives = scope.depth = touched_.camera != nullptr;
  scope.clouds = touched_.camera == nullptr;
  scope.spacing = source_.report().spacing;
  return scope;
}

void TabSource::prepare(const Preparation& wanted) {
  if (wanted == preparation_) return;
  source_.change(prepared_by(wanted, initial_, first_));
  try {
    if (touched_.camera == nullptr) source_.set(touched_.cloud);
  } catch (...) {
    source_.change(prepared_by(preparation_, initial_, first_));
    throw;
  }
  preparation_ = wanted;
}

void TabSource::advance(double time) {
  if (stream_) stream_->advance(std::max(time, kFirstFrame));
}

std::vector<ViewerOptions::Stream> TabSource::streams() const {
  if (!stream_) return {};
  return {{stream_->state(), session::frustum_of(lens_, source_.state().depth)}};
}

}  // namespace palpate::tab
