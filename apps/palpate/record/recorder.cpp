// Records a run on a thread of its own.
#include "apps/palpate/record/recorder.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <utility>

#include "apps/palpate/record/recording_file.hpp"
#include "ros/hand_messages.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"
#include "stream/source_trace.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kSteps = 8192;  // queue of a hand: 8 s at 1 kHz; judgement
std::int64_t wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

// A name after the time of day that no file has yet.
std::string free_name() {
  const std::string stem =
      fmt::format("palpate-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::string name = stem + ".mcap";
  std::error_code unknown;
  for (int i = 2; std::filesystem::exists(name, unknown); ++i)
    name = fmt::format("{}-{}.mcap", stem, i);
  return name;
}

}  // namespace

Recorder::Recorder(const std::string& path) : orders_(path) {
  if (path.empty()) return;
  present_.report.path = path;
  takes_frames_ = true;
  // A run that fails to begin must not overwrite an older recording.
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown))
    present_.file = std::make_unique<RecordingFile>(path);
}

Recorder::~Recorder() {
  if (thread_.joinable()) (void)finish();
}

StepTraces* Recorder::add_hand() {
  StepTraces& hand = hands_.emplace_back(kSteps);
  hand.accept(takes_frames_);
  return &hand;
}

void Recorder::begin(LoadedScene& loaded, std::vector<const Servo*> servos, double now,
                     bool waits) {
  subject_ = {&loaded, std::move(servos), wall_clock() - std::llround(1e9 * now)};
  waiting_.begin(loaded.scene.size(), waits);
  const std::string& path = present_.report.path;
  if (!present_.file && !path.empty()) present_.file = std::make_unique<RecordingFile>(path);
  if (present_.file) present_.file->begin(subject_.setup());
  thread_ = std::thread([this] { work(); });
}

std::string Recorder::record(bool on) {
  return orders_.record(on, [this] {
    RecordOrder order;
    order.path = free_name();
    order.file = std::make_unique<RecordingFile>(order.path);
    order.setup = subject_.setup();
    return order;
  });
}

void Recorder::on_broken(Broken broken) {
  const std::lock_guard lock(broken_mutex_);
  broken_ = std::move(broken);
}

Stream::Sink Recorder::watching(std::size_t source, Stream::Sink sink) {
  return [this, source, sink = std::move(sink)](const DepthFrame& frame,
                                                const Source::StartTime& start) {
    if (!takes_frames_) return sink(frame, start);
    message::FrameUse use;
    use.kind = frame.cloud ? "cloud" : "image";
    use.stamp = frame.stamp;
    if (frame.T_world_sensor) use.pose = session::rows_of(*frame.T_world_sensor);
    Source& its = subject_.source(source);
    const std::uint64_t before = SourceTrace(its).publications();
    const std::uint64_t dropped = its.state().dropped;
    const Source::StartTime noted_start = [&] { return use.start = start(); };
    std::exception_ptr problem;
    try {
      sink(frame, noted_start);
    } catch (const std::exception& error) {
      problem = std::current_exception();
      use.why_not = error.what();
    }
    use.dropped = its.state().dropped != dropped;
    if (use.dropped) use.why_not = "all snapshots were held";
    const bool shown = SourceTrace(its).publications() != before;
    if (!shown && use.why_not.empty()) use.why_not = "nothing was within reach";
    put(source, std::move(use), session::without_colors(frame));
    if (problem) std::rethrow_exception(problem);
  };
}

std::function<void()> Recorder::watching(std::size_t source, std::function<void()> ended) {
  return [this, source, ended = std::move(ended)] {
    ended();
    if (!takes_frames_) return;
    message::FrameUse use;
    use.kind = "end";
    put(source, std::move(use), {});
  };
}

// The thread that pushes.
void Recorder::put(std::size_t source, message::FrameUse use, DepthFrame frame) {
  const SourceTrace trace(subject_.source(source));
  use.publication = trace.publications();
  for (const Reach& ball : trace.reach()) {
    use.reach.insert(use.reach.end(),
                     {ball.center.x(), ball.center.y(), ball.center.z(), ball.radius});
  }
  waiting_.put(source, std::move(use), std::move(frame), trace);
}

void Recorder::note(double now, const std::optional<RosBridge::RobotState>& robot) {
  if (!robot) return;
  if (!takes_frames_) {
    robot_.clear();  // a file that begins later begins with what holds then
    return;
  }
  message::DiagnosticStatus status = ros::robot_status(*robot);
  if (std::exchange(robot_, status.message) == status.message) return;
  waiting_.put({now, std::move(status)});
}

void Recorder::keep_up() {
  while (std::ranges::any_of(hands_, &StepTraces::fills)) std::this_thread::sleep_for(kQueueLook);
}

void Recorder::work() {
  bool last = false;
  while (!last) {
    std::deque<RecordOrder> orders = orders_.wait(present_.file != nullptr, last);
    drain();
    for (RecordOrder& order : orders) carry_out(std::move(order));
  }
  close();
}

void Recorder::carry_out(RecordOrder order) {
  close();
  if (!order.file) return;
  drain();  // a step that came while the file before was closed
  present_ = {std::move(order.file), {}, dropped()};
  present_.report.path = order.path;
  waiting_.forget_gaps();
  accept(true);  // recorded is what comes from now on, though what follows takes its time
  try {
    present_.file->begin(order.setup);
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Recorder::accept(bool on) {
  for (StepTraces& hand : hands_) hand.accept(on);
  takes_frames_ = on;
}

void Recorder::drain() {
  const auto [frames, robots] = waiting_.take();
  const std::unique_ptr<RecordingFile>& file = present_.file;
  RecordReport& report = present_.report;
  try {
    for (const session::RecordedFrame& frame : frames) {
      if (file) file->write(frame);
      if (frame.use.kind != "end") ++report.frames;
    }
    for (const RecordedRobot& robot : robots) {
      if (file) file->write(robot);
    }
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      while (const StepTrace* const step = hands_[i].front()) {
        if (file) file->write(i, *step);
        ++report.steps;
        hands_[i].drop();
      }
    }
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Recorder::fail(const std::string& why) {
  present_.report.problem = why;
  orders_.forget(present_.report.path);
  close();
  drain();  // into nothing
  // Unlike fmt::print() this does not throw where standard error is full, too.
  std::fputs(fmt::format("\n{}\n", why).c_str(), stderr);
  const std::lock_guard lock(broken_mutex_);
  if (broken_) broken_(why);
}

// Writes what is queued and closes the file.
void Recorder::close() {
  std::unique_ptr<RecordingFile>& file = present_.file;
  RecordReport& report = present_.report;
  if (!file) return;
  accept(false);
  if (report.problem.empty()) drain();
  if (!file) return;  // that failed
  try {
    file->close();
  } catch (const std::exception& error) {
    if (report.problem.empty()) report.problem = error.what();
  }
  file.reset();
  report.lost_steps = dropped() - present_.dropped;
  report.lost_frames = waiting_.take_lost();
  reports_.push_back(std::move(report));
}

std::uint64_t Recorder::dropped() const {
  std::uint64_t sum = 0;
  for (const StepTraces& hand : hands_) sum += hand.dropped();
  return sum;
}

std::vector<RecordReport> Recorder::finish() {
  orders_.end();
  if (thread_.joinable()) thread_.join();
  close();  // where it had not begun
  return reports_;
}

}  // namespace palpate::app
