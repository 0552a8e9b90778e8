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

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recorded_messages.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "ros/hand_messages.hpp"
#include "scene/source_trace.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kSteps = 8192;     // queue of a hand: 8 s at 1 kHz; judgement
constexpr std::size_t kMostFrames = 16;  // queue of all sources: half a second at 30 Hz; judgement
constexpr std::chrono::milliseconds kLook{5};  // between two looks at the queues; judgement
std::int64_t wall_clock() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

// A name after the time of day that no file has yet.
std::string free_name() {
  const std::string stem =
      fmt::format("palpate-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::string name = stem + ".mcap";
  for (int i = 2; std::filesystem::exists(name); ++i) name = fmt::format("{}-{}.mcap", stem, i);
  return name;
}

}  // namespace

Recorder::Recorder(const std::string& path) : name_(path) {
  if (path.empty()) return;
  report_.path = path;
  takes_frames_ = true;
  // A run that fails to begin must not overwrite an older recording.
  if (!std::filesystem::is_regular_file(path)) file_ = std::make_unique<RecordingFile>(path);
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
  loaded_ = &loaded;
  servos_ = std::move(servos);
  waits_ = waits;
  epoch_ = wall_clock() - std::llround(1e9 * now);
  changes_.assign(loaded.scene.size(), 0);
  gaps_.assign(loaded.scene.size(), 0);
  if (!file_ && !report_.path.empty()) file_ = std::make_unique<RecordingFile>(report_.path);
  if (file_) file_->begin(setup_of(loaded, servos_, epoch_));
  thread_ = std::thread([this] { work(); });
}

std::string Recorder::record(bool on) {
  const std::lock_guard lock(mutex_);
  if (on != name_.empty()) return name_;
  Order order;
  if (on) {
    order.path = free_name();
    order.file = std::make_unique<RecordingFile>(order.path);
    order.setup = setup_of(*loaded_, servos_, epoch_);
  }
  std::string name = on ? order.path : name_;
  name_ = order.path;
  orders_.push_back(std::move(order));
  called_.notify_one();
  return name;
}

std::string Recorder::recording() const {
  const std::lock_guard lock(mutex_);
  return name_;
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
    if (frame.T_world_sensor) use.pose = rows_of(*frame.T_world_sensor);
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
    if (!takes_frames_) return;
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
  if (waits_) room_.wait(lock, [this] { return frames_.size() < kMostFrames; });
  if (frames_.size() >= kMostFrames && use.kind != "end") {
    ++lost_frames_;
    gaps_[source] = 1;
    return;
  }
  use.gap = std::exchange(gaps_[source], 0) != 0;
  if (trace.changes() != std::exchange(changes_[source], trace.changes())) {
    use.options = exact_json(trace.options()).dump();
  }
  frames_.push_back({source, std::move(frame), std::move(use)});
}

void Recorder::note(double now, const std::optional<RosBridge::RobotState>& robot) {
  if (!robot) return;
  if (!takes_frames_) {
    robot_.clear();  // a file that begins later begins with what holds then
    return;
  }
  message::DiagnosticStatus status = ros::robot_status(*robot);
  if (std::exchange(robot_, status.message) == status.message) return;
  const std::lock_guard lock(mutex_);
  robots_.push_back({now, std::move(status)});
}

void Recorder::keep_up() {
  while (std::ranges::any_of(hands_, &StepTraces::fills)) std::this_thread::sleep_for(kLook);
}

void Recorder::work() {
  bool last = false;
  while (!last) {
    std::deque<Order> orders;
    {
      std::unique_lock lock(mutex_);
      const auto called = [this] { return ending_ || !orders_.empty(); };
      if (file_) {
        called_.wait_for(lock, kLook, called);
      } else {
        called_.wait(lock, called);
      }
      orders.swap(orders_);
      last = ending_;
    }
    drain();
    for (Order& order : orders) carry_out(std::move(order));
  }
  close();
}

void Recorder::carry_out(Order order) {
  close();
  if (!order.file) return;
  drain();  // a step that came while the file before was closed
  dropped_ = dropped();
  report_ = {};
  report_.path = order.path;
  file_ = std::move(order.file);
  {
    const std::lock_guard lock(mutex_);
    gaps_.assign(gaps_.size(), 0);
  }
  accept(true);  // recorded is what comes from now on, though what follows takes its time
  try {
    file_->begin(order.setup);
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Recorder::accept(bool on) {
  for (StepTraces& hand : hands_) hand.accept(on);
  takes_frames_ = on;
}

void Recorder::drain() {
  std::deque<RecordedFrame> frames;
  std::deque<RecordedRobot> robots;
  {
    const std::lock_guard lock(mutex_);
    frames.swap(frames_);
    robots.swap(robots_);
  }
  room_.notify_all();
  try {
    for (const RecordedFrame& frame : frames) {
      if (file_) file_->write(frame);
      if (frame.use.kind != "end") ++report_.frames;
    }
    for (const RecordedRobot& robot : robots) {
      if (file_) file_->write(robot);
    }
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      while (const StepTrace* const step = hands_[i].front()) {
        if (file_) file_->write(i, *step);
        ++report_.steps;
        hands_[i].drop();
      }
    }
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void Recorder::fail(const std::string& why) {
  report_.problem = why;
  {
    const std::lock_guard lock(mutex_);
    if (name_ == report_.path) name_.clear();
  }
  close();
  drain();  // into nothing
  // Unlike fmt::print() this does not throw where standard error is full, too.
  std::fputs(fmt::format("\n{}\n", why).c_str(), stderr);
  const std::lock_guard lock(broken_mutex_);
  if (broken_) broken_(why);
}

// Writes what is queued and closes the file.
void Recorder::close() {
  if (!file_) return;
  accept(false);
  if (report_.problem.empty()) drain();
  if (!file_) return;  // that failed
  try {
    file_->close();
  } catch (const std::exception& error) {
    if (report_.problem.empty()) report_.problem = error.what();
  }
  file_.reset();
  report_.lost_steps = dropped() - dropped_;
  const std::lock_guard lock(mutex_);
  report_.lost_frames = std::exchange(lost_frames_, 0);
  reports_.push_back(std::move(report_));
}

std::uint64_t Recorder::dropped() const {
  std::uint64_t sum = 0;
  for (const StepTraces& hand : hands_) sum += hand.dropped();
  return sum;
}

std::vector<RecordReport> Recorder::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  called_.notify_one();
  if (thread_.joinable()) thread_.join();
  close();  // where it had not begun
  return reports_;
}

}  // namespace palpate::app
