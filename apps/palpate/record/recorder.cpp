#include "apps/palpate/record/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "scene/source_trace.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kSteps = 8192;     // that wait at most, of a hand
constexpr std::size_t kMostFrames = 16;  // of all sources
constexpr std::chrono::milliseconds kLook{5};

std::int64_t wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

std::vector<double> rows(const Eigen::Isometry3d& pose) {
  std::vector<double> values;
  for (int i = 0; i < 12; ++i) values.push_back(pose.matrix()(i / 4, i % 4));
  return values;
}

// Without what no surface depends on.
DepthFrame without_colors(const DepthFrame& frame) {
  DepthFrame kept;
  kept.camera = frame.camera;
  kept.stamp = frame.stamp;
  kept.T_world_sensor = frame.T_world_sensor;
  kept.depth = frame.depth;
  kept.cloud = frame.cloud;
  return kept;
}

}  // namespace

Recorder::Recorder(const std::string& path) : file_(std::make_unique<RecordingFile>(path)) {
  report_.path = path;
}

Recorder::~Recorder() {
  if (thread_.joinable()) (void)finish();
}

StepTraces* Recorder::add_hand() {
  return &hands_.emplace_back(kSteps);
}

void Recorder::begin(LoadedScene& loaded, const std::vector<const Servo*>& servos, double now,
                     bool waits) {
  loaded_ = &loaded;
  waits_ = waits;
  changes_.assign(loaded.scene.size(), 0);
  file_->begin(loaded, servos, wall_clock() - std::llround(1e9 * now));
  thread_ = std::thread([this] { work(); });
}

Stream::Sink Recorder::watching(std::size_t source, Stream::Sink sink) {
  return [this, source, sink = std::move(sink)](const DepthFrame& frame,
                                                const Source::StartTime& start) {
    message::FrameUse use;
    use.kind = frame.cloud ? "cloud" : "image";
    use.stamp = frame.stamp;
    if (frame.T_world_sensor) use.pose = rows(*frame.T_world_sensor);
    const std::uint64_t before = SourceTrace(loaded_->scene.source(source)).publications();
    const std::uint64_t dropped = loaded_->scene.source(source).state().dropped;
    const Source::StartTime asked = [&] { return use.start = start(); };
    std::exception_ptr problem;
    try {
      sink(frame, asked);
    } catch (const std::exception& error) {
      problem = std::current_exception();
      use.why_not = error.what();
    }
    const Source& its = loaded_->scene.source(source);
    use.dropped = its.state().dropped != dropped;
    if (use.dropped) use.why_not = "all snapshots were held";
    const bool shown = SourceTrace(loaded_->scene.source(source)).publications() != before;
    if (!shown && use.why_not.empty()) use.why_not = "nothing was within reach";
    put(source, std::move(use), without_colors(frame));
    if (problem) std::rethrow_exception(problem);
  };
}

std::function<void()> Recorder::watching(std::size_t source, std::function<void()> ended) {
  return [this, source, ended = std::move(ended)] {
    ended();
    message::FrameUse use;
    use.kind = "end";
    put(source, std::move(use), {});
  };
}

// The thread that pushes.
void Recorder::put(std::size_t source, message::FrameUse use, DepthFrame frame) {
  const SourceTrace trace(loaded_->scene.source(source));
  use.publication = trace.publications();
  for (const Reach& ball : trace.reach()) {
    use.reach.insert(use.reach.end(),
                     {ball.center.x(), ball.center.y(), ball.center.z(), ball.radius});
  }
  std::unique_lock lock(mutex_);
  if (trace.changes() != std::exchange(changes_[source], trace.changes())) {
    use.options = exact_json(loaded_->scene.source(source).options()).dump();
  }
  if (waits_) room_.wait(lock, [this] { return frames_.size() < kMostFrames; });
  if (frames_.size() >= kMostFrames && use.kind != "end") {
    ++report_.lost_frames;
    return;
  }
  frames_.push_back({source, std::move(frame), std::move(use)});
}

void Recorder::keep_up() {
  while (std::ranges::any_of(hands_, &StepTraces::fills)) std::this_thread::sleep_for(kLook);
}

void Recorder::work() {
  bool last = false;
  while (!last) {
    {
      std::unique_lock lock(mutex_);
      ended_.wait_for(lock, kLook, [this] { return ending_; });
      last = ending_;
    }
    try {
      drain(report_.problem.empty());
    } catch (const std::exception& error) {
      report_.problem = error.what();
    }
  }
}

void Recorder::drain(bool writes) {
  std::deque<RecordedFrame> frames;
  {
    const std::lock_guard lock(mutex_);
    frames.swap(frames_);
  }
  room_.notify_all();
  for (const RecordedFrame& frame : frames) {
    if (writes) file_->write(frame);
    if (writes && frame.use.kind != "end") ++report_.frames;
  }
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    while (const StepTrace* const step = hands_[i].front()) {
      if (writes) file_->write(i, *step);
      if (writes) ++report_.steps;
      hands_[i].drop();
    }
  }
}

RecordReport Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ended_.notify_one();
  if (thread_.joinable()) thread_.join();
  try {
    file_->close();
  } catch (const std::exception& error) {
    if (report_.problem.empty()) report_.problem = error.what();
  }
  for (const StepTraces& hand : hands_) report_.lost_steps += hand.dropped();
  return report_;
}

}  // namespace palpate::app
