#include "palpate/scene/source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/scene/snapshot.hpp"
#include "prepare/check_input.hpp"
#include "scene/intake.hpp"
#include "scene/seams.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {
namespace {

// How sources disagree changes slowly, and takes milliseconds to tell.
constexpr std::uint64_t kComparedFrames = 32;

void check_factor(const std::string& name, const char* option, double factor) {
  if (factor >= 0 && factor <= 1) return;
  throw Error(
      fmt::format("source '{}': {} is {}; it must be between 0 and 1", name, option, factor));
}

void check(const std::string& name, const Snapshot& snapshot) {
  if (snapshot.layers.size() > Snapshot::kMaxLayers) {
    throw Error(fmt::format("source '{}': a snapshot of {} layers; give at most {}", name,
                            snapshot.layers.size(), Snapshot::kMaxLayers));
  }
  if (!std::isfinite(snapshot.start) || !std::isfinite(snapshot.end) ||
      snapshot.end < snapshot.start) {
    throw Error(
        fmt::format("source '{}': a snapshot from {} s to {} s; give finite times, in order", name,
                    snapshot.start, snapshot.end));
  }
  check_factor(name, "presence_start", snapshot.presence_start);
  check_factor(name, "presence_end", snapshot.presence_end);
  for (const Layer& layer : snapshot.layers) {
    if (!layer.points)
      throw Error(fmt::format("source '{}': a layer has no points; give every layer some", name));
    check_factor(name, "a layer's weight_start", layer.weight_start);
    check_factor(name, "a layer's weight_end", layer.weight_end);
    check(*layer.points);
  }
}

/// Is the cloud to be felt as the depth frame that it was made of, if there is one?
bool wants_image(const PointCloud& cloud, const SourceOptions& options) {
  const PrepareOptions& loose = options.prepare;
  return options.organised && cloud.width > 0 && !loose.voxel && !loose.clip && !loose.viewpoint &&
         !loose.material_from_intensity && !loose.paper;
}

/// Is most of what the frame measured at depths that are felt?
bool is_mostly_felt(const DepthFrame& frame, const DepthFilterOptions& options) {
  const auto within = [&](float z) {
    return static_cast<double>(z) > options.nearest && static_cast<double>(z) < options.farthest;
  };
  const auto felt = std::ranges::count_if(frame.depth, within);
  return 2 * felt > std::ranges::count_if(frame.depth, [](float z) { return z > 0; });
}

/// Errors of what `act` does, with the source's name.
template <class Act>
auto named(const std::string& name, const Act& act) {
  try {
    return act();
  } catch (const Error& error) {
    throw Error(fmt::format("source '{}': {}", name, error.what()));
  }
}

}  // namespace

Source::Source(std::string name, const SourceOptions& options)
    : name_(std::move(name)),
      options_(options),
      pose_(options.T_world_sensor),
      reaches_(std::make_unique<ReachBoard>()) {
  check_factor(name_, "soft.stiffness_factor", options_.soft.stiffness_factor);
  check_factor(name_, "soft.friction_factor", options_.soft.friction_factor);
  named(name_, [&] { intake_ = std::make_unique<Intake>(options_); });
}

Source::~Source() = default;

SourceOptions Source::options() const {
  const std::lock_guard lock(mutex_);
  return options_;
}

void Source::change(const SourceOptions& options) {
  std::unique_ptr<Intake> changed;
  named(name_, [&] { changed = std::make_unique<Intake>(options); });
  const std::lock_guard lock(mutex_);
  changed_ = std::move(changed);
  options_.prepare = options.prepare;
  options_.policy = options.policy;
  options_.depth = options.depth;
  options_.organised = options.organised;
}

void Source::take_change() {
  const std::lock_guard lock(mutex_);
  if (changed_) intake_ = std::move(changed_);
}

PrepareReport Source::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

Eigen::Isometry3d Source::pose() const {
  const std::lock_guard lock(mutex_);
  return pose_;
}

void Source::set_pose(const Eigen::Isometry3d& T_world_sensor) {
  named(name_, [&] { check_pose(T_world_sensor); });
  const std::lock_guard lock(mutex_);
  pose_ = T_world_sensor;
}

void Source::set(const PointCloud& cloud) {
  const SourceOptions wanted = options();
  if (wants_image(cloud, wanted)) {
    OrganisedFrame image = depth_frame_of(cloud);
    if (image.frame && is_mostly_felt(*image.frame, wanted.depth)) {
      auto& pose_in_cloud = image.frame->T_world_sensor;
      pose_in_cloud = pose() * pose_in_cloud.value_or(Eigen::Isometry3d::Identity());
      set(*image.frame);
      return;
    }
  }
  Prepared prepared = named(name_, [&] { return prepare(cloud, wanted.prepare, pose()); });
  {
    const std::lock_guard lock(mutex_);
    report_ = prepared.report;
    state_ = {};
  }
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->layers.push_back(
      {std::make_shared<const SurfacePoints>(std::move(prepared.points)), 1, 1});
  publish(std::move(snapshot));
}

void Source::set(const DepthFrame& frame) {
  SourceOptions whole = options();
  whole.policy = {.fit_everywhere = true};
  const StartTime at_once = [] { return 0.0; };
  const Eigen::Isometry3d stand = frame.T_world_sensor.value_or(pose());
  auto snapshot = std::make_shared<Snapshot>();
  named(name_, [&] {
    check_pose(stand);
    Intake intake(whole);
    snapshot->layers = intake.take(frame, {stand, {}, at_once})->layers;
    const std::lock_guard lock(mutex_);
    state_ = {};
    note(*snapshot);
    note(intake);
  });
  publish(std::move(snapshot));
}

bool Source::push(const DepthFrame& frame, const StartTime& start) {
  take_change();
  if (!room_for(false)) return false;
  reaches_->read(found_);
  named(name_, [&] {
    const Eigen::Isometry3d pose_now = frame.T_world_sensor ? *frame.T_world_sensor : pose();
    if (frame.T_world_sensor) check_pose(pose_now);
    hand_over(intake_->take(frame, {pose_now, found_, start}));
  });
  const std::lock_guard lock(mutex_);
  note(*intake_);
  return true;
}

bool Source::push(const PointCloud& cloud, double stamp, const StartTime& start) {
  take_change();
  if (!room_for(true)) return false;
  reaches_->read(found_);
  PrepareReport report;
  named(name_, [&] { hand_over(intake_->take(cloud, stamp, {pose(), found_, start}, report)); });
  const std::lock_guard lock(mutex_);
  report_ = report;
  return true;
}

void Source::keep() {
  const Snapshot* newest = handoff_.peek();  // nobody else publishes, so nobody frees it
  if (newest == nullptr) return;
  std::shared_ptr<Snapshot> kept = room_for(false) ? intake_->last_of_frames(*newest) : nullptr;
  if (!kept) kept = std::make_shared<Snapshot>(*newest);
  kept->silent_from = std::numeric_limits<double>::infinity();
  {
    const std::lock_guard lock(mutex_);
    points_ = kept->layers.empty() ? nullptr : kept->layers.back().points;
    state_.silent_from = kept->silent_from;
  }
  handoff_.publish(std::move(kept));
}

/// May one more snapshot be made? If not, says whom it waits for.
bool Source::room_for(bool clouds) {
  const std::size_t most = intake_->most_snapshots(clouds, handoff_.readers());
  if (handoff_.alive() < most) return true;
  handoff_.sweep();
  if (handoff_.alive() < most) return true;
  std::string slowest = handoff_.slowest();
  const std::lock_guard lock(mutex_);
  ++state_.dropped;
  state_.slowest = std::move(slowest);
  return false;
}

void Source::hand_over(std::shared_ptr<const Snapshot> snapshot) {
  if (!snapshot) return;
  {
    const std::lock_guard lock(mutex_);
    note(*snapshot);
  }
  handoff_.publish(std::move(snapshot));
  if (state_.frames % kComparedFrames == 1) compare();
}

void Source::compare() {
  if (seams_) seams_->compare(place_, *this);
}

void Source::note(const Snapshot& snapshot) {
  points_ = snapshot.layers.back().points;
  ++state_.frames;
  state_.interval = state_.frames > 1 ? intake_->interval() : 0;
  state_.latency = snapshot.start - snapshot.stamp;
  state_.stamp = snapshot.stamp;
  state_.points = points_->size();
  state_.silent_from = snapshot.silent_from;
  state_.fade = snapshot.fade;
}

void Source::note(const Intake& intake) {
  state_.depth = intake.median_depth();
  state_.noise = intake.noise().sigma(state_.depth);
  state_.correlation = intake.noise().correlation;
}

void Source::publish(std::shared_ptr<const Snapshot> snapshot) {
  if (snapshot) check(name_, *snapshot);
  {
    const std::lock_guard lock(mutex_);
    points_ = snapshot && !snapshot->layers.empty() ? snapshot->layers.front().points : nullptr;
  }
  handoff_.publish(std::move(snapshot));
  compare();
}

std::shared_ptr<const SurfacePoints> Source::points() const {
  const std::lock_guard lock(mutex_);
  return points_;
}

SourceState Source::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

double progress(const Snapshot& snapshot, double time) noexcept {
  const double duration = snapshot.end - snapshot.start;
  if (!(duration > 0)) return time < snapshot.start ? 0 : 1;
  return std::clamp((time - snapshot.start) / duration, 0.0, 1.0);
}

double presence(const Snapshot& snapshot, double time) noexcept {
  const double own = snapshot.presence_start +
                     progress(snapshot, time) * (snapshot.presence_end - snapshot.presence_start);
  const double silence = time - snapshot.silent_from;
  if (!(silence > 0)) return own;
  return snapshot.fade > 0 ? own * std::clamp(1 - silence / snapshot.fade, 0.0, 1.0) : 0;
}

}  // namespace palpate
