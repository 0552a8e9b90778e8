// Shows hands and sources of a recorded run at any moment.
#include "session/shown_run.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <utility>

#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "servo/step_trace.hpp"
#include "session/frames.hpp"
#include "session/recorded_messages.hpp"

namespace palpate::session {

namespace {

constexpr double kReadOn = 0.5;  // s that are read on to come to a later frame

// s that are looked through for a frame before a moment. Most often there is one just before it,
// and a second of them is some 40 MB.
constexpr std::array<double, 4> kFramesBack{0.2, 1, 10, std::numeric_limits<double>::infinity()};

constexpr int kMostDamaged = 100;  // steps that are passed over; judgement

void count(GuardNote notes, Guard::State::Counts& counts) {
  const auto add = [notes](GuardNote bit, std::uint64_t& count) {
    count += has(notes, bit) ? 1 : 0;
  };
  ++counts.steps;
  add(GuardNote::slewed, counts.slewed);
  add(GuardNote::clamped, counts.clamped);
  add(GuardNote::silence, counts.silences);
  add(GuardNote::braked, counts.braked);
  add(GuardNote::starting, counts.starting);
  add(GuardNote::softened, counts.softened);
}

}  // namespace

ShownHand::ShownHand(const Recording& recording, std::size_t index, Scene& scene)
    : hand_(&recording.hands().at(index)),
      steps_(recording, index),
      earlier_(recording, index),
      device_(hand_->device),
      servo_(device_, scene, hand_->options) {}

void ShownHand::show(const Recording::Step& step) {
  ServoState state = state_of(step.tick, step.tool, hand_->options);
  count(state.guard.notes, counts_);
  state.guard.counts = counts_;
  ServoTrace(servo_).show(state);
}

void ShownHand::seek(double time) {
  if (const std::optional<Recording::Step> step = steps_.at(time)) show(*step);
}

void ShownHand::advance(double time) {
  while (const std::optional<Recording::Step> step = steps_.next(time)) show(*step);
}

std::vector<ViewerControls::TimeLine::Force> ShownHand::past(
    double span, const std::function<bool()>& cancelled) {
  std::vector<ViewerControls::TimeLine::Force> forces;
  const double now = servo_.state().time;
  earlier_.seek(now - span);
  for (int damaged = 0; damaged < kMostDamaged;) {
    if (cancelled()) return {};
    try {
      const std::optional<Recording::Step> step = earlier_.next(now);
      if (!step) break;
      forces.push_back({step->tick.time, message::eigen(step->tick.force).cast<float>()});
    } catch (const Error&) {
      ++damaged;
    }
  }
  return forces;
}

ShownSource::ShownSource(const Recording& recording, std::size_t index, Scene& scene)
    : source_(&recording.add_source(index, scene)),
      origin_(&recording.sources()[index]),
      frames_(recording, index) {
  if (!lives()) return;
  stream_.state.source = source_->name();
  stream_.state.phase = StreamState::Phase::running;
  upcoming_ = next_felt();
  begins_ = upcoming_ ? upcoming_->use.start : std::numeric_limits<double>::infinity();
  if (!upcoming_) return;
  shown_until_ = begins_;
  prepare(*upcoming_);
}

std::optional<RecordedFrame> ShownSource::next_felt() {
  while (std::optional<RecordedFrame> frame = frames_.next()) {
    const message::FrameUse& use = frame->use;
    if (use.kind != "end" && use.why_not.empty() && !use.dropped) return frame;
  }
  return std::nullopt;
}

// Takes the newest frame that was felt up to `time`. What is damaged is passed over by the next
// call.
void ShownSource::read_on(double time, std::optional<RecordedFrame>& newest) {
  for (;;) {
    if (!upcoming_) upcoming_ = next_felt();
    if (!upcoming_ || upcoming_->use.start > time) return;
    newest = std::exchange(upcoming_, std::nullopt);
  }
}

void ShownSource::show(double time) {
  std::optional<RecordedFrame> newest;
  std::exception_ptr damage;
  const auto look = [&] {
    try {
      read_on(time, newest);
    } catch (const std::exception&) {
      damage = std::current_exception();
    }
  };
  const bool goes_on = time >= shown_until_ && time - shown_until_ < kReadOn;
  shown_until_ = time;
  if (goes_on) {
    look();
    if (newest) prepare(*newest);
  } else {
    for (const double back : kFramesBack) {
      frames_.seek(time - back);
      upcoming_.reset();
      look();
      if (newest) break;
    }
    newest ? prepare(*newest) : source_->publish(nullptr);
  }
  if (damage) std::rethrow_exception(damage);
}

// Prepares the frame alone, without the frames before it and without where tools were.
void ShownSource::prepare(const RecordedFrame& recorded) {
  const DepthFrame& frame = recorded.frame;
  Source prepared(source_->name(), source_->options());
  if (frame.cloud) {
    if (frame.T_world_sensor) prepared.set_pose(*frame.T_world_sensor);
    prepared.set(*frame.cloud);
  } else if (origin_->as_cloud) {
    if (frame.T_world_sensor) prepared.set_pose(*frame.T_world_sensor);
    prepared.set(cloud_of(frame));
  } else {
    prepared.set(frame);
  }
  publish_surface(prepared, *source_);
  const std::lock_guard lock(mutex_);
  stream_.T_world_sensor = frame.T_world_sensor;
  stream_.frustum.reset();
  if (frame.cloud) return;
  stream_.frustum = frustum_of(frame.camera, prepared.state().depth);
}

ShownSource::Stream ShownSource::stream() const {
  const std::lock_guard lock(mutex_);
  return stream_;
}

double ShownRun::first_surface() const {
  const auto first = std::ranges::min_element(sources, {}, &ShownSource::begins);
  if (first == sources.end() || !(first->begins() <= stretch.end)) return 0;
  constexpr double kRounding = 1e-6;  // s: a sum of times must not be before the frame
  return std::clamp(first->begins() + kRounding - stretch.begin, 0.0, length());
}

ShownRun::ShownRun(bag::RandomFile file)
    : recording(std::move(file)), stretch(recording.stretch()) {
  for (std::size_t i = 0; i < recording.sources().size(); ++i) {
    sources.emplace_back(recording, i, scene);
  }
  for (std::size_t i = 0; i < recording.hands().size(); ++i) {
    hands.emplace_back(recording, i, scene);
  }
}

}  // namespace palpate::session
