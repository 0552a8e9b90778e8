// Collects the reports of sources, streams and hands that the page shows.
#include "viewer/reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace palpate::viewer {

namespace {

const ViewedStream* stream_of(std::span<const ViewedStream> streams, const std::string& source) {
  const auto found = std::ranges::find_if(
      streams, [&](const ViewedStream& stream) { return stream.state.source == source; });
  return found == streams.end() ? nullptr : &*found;
}

void add_stream(const ViewedStream& stream, const Source& source, const Eigen::Vector3d& origin,
                SourceReport& report) {
  report.rate = stream.state.rate;
  report.dropped += stream.state.drops.total();
  report.frustum = stream.frustum;
  Eigen::Isometry3d pose = stream.T_world_sensor.value_or(source.pose());
  pose.translation() -= origin;
  report.pose = pose;
}

constexpr double kRateTime = 0.5;  // s that a rate is counted over (judgement)

std::array<float, 2> quantiles(const Durations& now, Durations& before) {
  const Durations since = now.since(before);
  before = now;
  return {static_cast<float>(since.quantile(0.5)), static_cast<float>(since.quantile(0.99))};
}

ToolPart tool_part(const ServoState& state, double scale) {
  ToolPart part;
  part.orientation = state.tool.orientation.cast<float>();
  part.opening = static_cast<float>(state.tool.opening);
  part.hand_opening = static_cast<float>(scale * state.gripper);
  part.torque = state.wrench.torque.cast<float>();
  part.grip = static_cast<float>(state.wrench.grip);
  return part;
}

bool lasts(const StreamState& stream) {
  return stream.phase == StreamState::Phase::stalled || stream.phase == StreamState::Phase::failed;
}

}  // namespace

std::vector<std::string> tool_names(const std::vector<Servo*>& servos) {
  std::map<std::string, int> count;
  for (const Servo* servo : servos) ++count[servo->device().info().name];
  std::map<std::string, int> seen;
  std::vector<std::string> names;
  for (const Servo* servo : servos) {
    const std::string& name = servo->device().info().name;
    names.push_back(count[name] == 1 ? name : fmt::format("{} {}", name, ++seen[name]));
  }
  return names;
}

std::vector<SourceReport> source_reports(const Scene& scene, std::span<const ViewedStream> streams,
                                         const Eigen::Vector3d& origin, double now) {
  std::vector<SourceReport> reports;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    const Source::State state = scene.state(i);
    const ViewedStream* stream = stream_of(streams, source.name());
    const auto points = source.points();
    SourceReport report;
    report.name = source.name();
    report.phase = stream == nullptr ? "still" : name_of(stream->state.phase);
    report.rate = state.rate();
    report.points = points ? points->size() : 0;
    report.latency = state.latency;
    if (state.frames > 0) report.age = now - state.stamp;
    report.dropped = state.dropped;
    report.disagreement = state.disagreement;
    if (stream != nullptr) add_stream(*stream, source, origin, report);
    reports.push_back(std::move(report));
  }
  return reports;
}

std::optional<StateMessage> StateReporter::next(double now, double radius, bool taken) {
  const ServoState state = servo_.state();
  if (state.step == 0) return std::nullopt;
  StateMessage message;
  message.device = device_;
  message.flags = flags(state, taken);
  message.time = state.time;
  const bool hip_is_finite = state.hip.allFinite();  // no fault of the device
  message.hip = ((hip_is_finite ? state.hip : state.contact.proxy) - origin_).cast<float>();
  message.proxy = (state.contact.proxy - origin_).cast<float>();
  message.normal = state.contact.normal.cast<float>();
  message.force = state.force.cast<float>();
  message.radius = static_cast<float>(radius);
  message.rate = static_cast<float>(rate(now, state.step));
  const StepDurations durations = servo_.durations();
  message.computing = quantiles(durations.computing, durations_.computing);
  message.lateness = quantiles(durations.lateness, durations_.lateness);
  message.interval = static_cast<float>(interval(state));
  message.forces = forces_until(state.step);
  const bool holds_tool = servo_.options().tool != nullptr;
  if (holds_tool) {
    message.flags |= state_flag::kTool;
    message.tool = tool_part(state, servo_.options().workspace.scale);
  }
  if (holds_tool || servo_.device().info().has_orientation) {
    message.orientation = state.orientation.cast<float>();
  }
  return message;
}

// On average since the message before, so that samples do not overlap where steps came unevenly.
double StateReporter::interval(const ServoState& state) {
  const std::uint64_t steps = state.step - step_;
  const double mean = steps > 0 ? (state.time - time_) / static_cast<double>(steps) : 0;
  const bool measured = step_ > 0 && mean > 0;
  step_ = state.step;
  time_ = state.time;
  return measured ? mean : state.dt;
}

// Forces after `step` wait for the next message.
std::vector<Eigen::Vector3f> StateReporter::forces_until(std::uint64_t step) {
  std::vector<Eigen::Vector3f> forces = servo_.forces_since(forces_seen_);
  if (forces_seen_ <= step) return forces;
  const std::uint64_t later = std::min<std::uint64_t>(forces_seen_ - step, forces.size());
  forces.resize(forces.size() - static_cast<std::size_t>(later));
  forces_seen_ -= later;
  return forces;
}

// Flags what the guard did in any step since the last message, not only in the newest step.
std::uint32_t StateReporter::flags(const ServoState& state, bool taken) {
  const Guard::State::Counts& counts = state.guard.counts;
  std::uint32_t flags = 0;
  const auto set = [&flags](bool is, std::uint32_t flag) { flags |= is ? flag : 0; };
  set(state.contact.touching, state_flag::kTouching);
  set(state.paused, state_flag::kPaused);
  set(taken, state_flag::kTaken);
  set(counts.clamped > counts_.clamped, state_flag::kClamped);
  set(counts.slewed > counts_.slewed, state_flag::kSlewed);
  set(counts.silences > counts_.silences, state_flag::kWatchdog);
  set(counts.braked > counts_.braked, state_flag::kBraked);
  set(counts.starting > counts_.starting, state_flag::kStarting);
  set(counts.softened > counts_.softened, state_flag::kSoftened);
  set(state.clutched, state_flag::kClutched);
  set(state.guard.fault != Guard::Fault::none, state_flag::kFault);
  set(has(state.field_notes, FieldNote::thinned), state_flag::kThinned);
  set(has(state.field_notes, FieldNote::behind), state_flag::kBehind);
  set(has(state.field_notes, FieldNote::not_loaded), state_flag::kNotLoaded);
  set(has(state.contact.notes, ContactNote::softer), state_flag::kSofter);
  set(has(state.contact.notes, ContactNote::inside), state_flag::kInside);
  counts_ = counts;
  return flags;
}

double StateReporter::rate(double now, std::uint64_t step) {
  steps_.emplace_back(now, step);
  while (steps_.size() > 2 && now - steps_[1].first >= kRateTime) steps_.pop_front();
  const double time = now - steps_.front().first;
  return time > 0 ? static_cast<double>(step - steps_.front().second) / time : 0;
}

std::vector<Notice> FaultNotices::update(std::span<const ViewedStream> streams,
                                         std::span<const DeviceFault> devices) {
  std::vector<Notice> news;
  const std::vector<Notice> before = std::exchange(present_, {});
  for (const ViewedStream& stream : streams) {
    const Notice notice{Viewer::NoticeLevel::warning, stream.state.problem};
    if (is_new(stream.state)) news.push_back(notice);
    if (lasts(stream.state) && !notice.text.empty()) present_.push_back(notice);
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& [name, fault] = devices[i];
    const bool changed = std::exchange(faults_[i], fault) != fault;
    if (fault == Guard::Fault::none) continue;
    present_.push_back({Viewer::NoticeLevel::fault, fmt::format("{}: {}", name, in_words(fault))});
    if (changed) news.push_back(present_.back());
  }
  for (Notice notice : before) {
    if (std::ranges::find(present_, notice) != present_.end()) continue;
    notice.over = true;
    news.push_back(std::move(notice));
  }
  return news;
}

// A problem that repeats itself with every frame is reported once.
bool FaultNotices::is_new(const StreamState& stream) {
  Problem& last = problems_[stream.source];
  const bool repeated = last.words == stream.problem && stream.problem_at - last.time <= kPeace;
  last = {stream.problem, stream.problem_at};
  return !stream.problem.empty() && !repeated;
}

}  // namespace palpate::viewer
