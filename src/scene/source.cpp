// Takes frames and clouds, has snapshots made of them, and hands these over to readers.
#include "palpate/scene/source.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palpate/base/error.hpp"
#include "prepare/place.hpp"
#include "scene/source_inside.hpp"

namespace palpate {
namespace {

// How sources disagree changes slowly, and takes milliseconds to measure: frames between
// two looks (judgement).
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
  for (const Snapshot::Layer& layer : snapshot.layers) {
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
    : inside_(std::make_unique<Inside>()) {
  inside_->name = std::move(name);
  inside_->options = options;
  inside_->pose = options.T_world_sensor;
  check_factor(inside_->name, "soft.stiffness_factor", options.soft.stiffness_factor);
  check_factor(inside_->name, "soft.friction_factor", options.soft.friction_factor);
  named(inside_->name, [&] { inside_->builder = std::make_unique<SnapshotBuilder>(options); });
}

Source::~Source() = default;

const std::string& Source::name() const {
  return inside_->name;
}

SourceOptions Source::options() const {
  return inside_->copy(&Inside::options);
}

void Source::change(const SourceOptions& options) {
  std::unique_ptr<SnapshotBuilder> changed;
  named(inside_->name, [&] { changed = std::make_unique<SnapshotBuilder>(options); });
  const std::lock_guard lock(inside_->mutex);
  inside_->changed = std::move(changed);
  inside_->options.prepare = options.prepare;
  inside_->options.policy = options.policy;
  inside_->options.depth = options.depth;
  inside_->options.organised = options.organised;
}

void Source::Inside::take_change() {
  const std::lock_guard lock(mutex);
  if (!changed) return;
  builder = std::move(changed);
  taken = options;
  ++changes;
}

Prepared::Report Source::report() const {
  return inside_->copy(&Inside::report);
}

Eigen::Isometry3d Source::pose() const {
  return inside_->copy(&Inside::pose);
}

void Source::set_pose(const Eigen::Isometry3d& T_world_sensor) {
  named(inside_->name, [&] { check_pose(T_world_sensor); });
  const std::lock_guard lock(inside_->mutex);
  inside_->pose = T_world_sensor;
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
  Prepared prepared = named(inside_->name, [&] { return prepare(cloud, wanted.prepare, pose()); });
  prepared.points.eye = OneView{}.eye_of(cloud, wanted.prepare, pose());
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->report = prepared.report;
    inside_->state = {};
  }
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->layers.push_back(
      {std::make_shared<const SurfacePoints>(std::move(prepared.points)), 1, 1});
  snapshot->publication = ++inside_->publications;
  publish(std::move(snapshot));
}

void Source::set(const DepthFrame& frame) {
  SourceOptions whole = options();
  whole.policy = {.fit_everywhere = true};
  const Source::StartTime at_once = [] { return 0.0; };
  const Eigen::Isometry3d stand = frame.T_world_sensor.value_or(pose());
  auto snapshot = std::make_shared<Snapshot>();
  NoiseModel noise;
  named(inside_->name, [&] {
    check_pose(stand);
    SnapshotBuilder builder(whole);
    snapshot->layers = builder.take(frame, {stand, {}, at_once})->layers;
    noise = builder.noise();
    const std::lock_guard lock(inside_->mutex);
    inside_->state = {};
    inside_->note(*snapshot);
    inside_->note(builder);
  });
  snapshot->publication = ++inside_->publications;
  publish(std::move(snapshot));
  inside_->sight.see(frame, stand, noise);
  inside_->stays = true;
}

bool Source::push(const DepthFrame& frame, const Source::StartTime& start) {
  inside_->take_change();
  inside_->stays = false;
  inside_->notes = {};
  const Eigen::Isometry3d pose_now = frame.T_world_sensor.value_or(pose());
  named(inside_->name, [&] {
    if (frame.T_world_sensor) check_pose(pose_now);
    if (inside_->watched) inside_->show(frame, pose_now);
  });
  if (!inside_->room_for(false)) return false;
  inside_->reaches.read(inside_->found);
  named(inside_->name, [&] {
    inside_->hand_over(*this, inside_->builder->take(frame, {pose_now, inside_->found, start}));
  });
  const std::lock_guard lock(inside_->mutex);
  inside_->note(*inside_->builder);
  return true;
}

bool Source::push(const PointCloud& cloud, double stamp, const Source::StartTime& start) {
  inside_->take_change();
  inside_->sight.forget();
  if (!inside_->room_for(true)) return false;
  inside_->reaches.read(inside_->found);
  CloudNotes& notes = inside_->notes;
  named(inside_->name, [&] {
    const Arrival arrival{pose(), inside_->found, start};
    inside_->hand_over(*this, inside_->builder->take(cloud, stamp, arrival, notes), &notes);
  });
  return true;
}

void Source::keep() {
  const Snapshot* newest = inside_->handoff.peek();  // nobody else publishes, so nobody frees it
  if (newest == nullptr) return;
  std::shared_ptr<Snapshot> kept =
      inside_->room_for(false) ? inside_->builder->last_of(*newest, inside_->notes) : nullptr;
  const bool whole = kept != nullptr;
  if (!whole) kept = std::make_shared<Snapshot>(*newest);
  kept->silent_from = std::numeric_limits<double>::infinity();
  kept->publication = ++inside_->publications;
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->note_surface(*kept);
    if (whole) inside_->state.overview = nullptr;
  }
  inside_->handoff.publish(std::move(kept));
}

/// May one more snapshot be made? If not, says whom it waits for.
bool Source::Inside::room_for(bool clouds) {
  const std::size_t most = builder->most_snapshots(clouds, handoff.readers());
  if (handoff.alive() < most) return true;
  handoff.sweep();
  if (handoff.alive() < most) return true;
  std::string slowest = handoff.slowest();
  const std::lock_guard lock(mutex);
  ++state.dropped;
  state.slowest = std::move(slowest);
  return false;
}

void Source::Inside::hand_over(const Source& source, std::shared_ptr<Snapshot> snapshot,
                               const CloudNotes* cloud) {
  snapshot->publication = ++publications;
  {
    const std::lock_guard lock(mutex);
    note(*snapshot);
    if (cloud) report = cloud->report;
    state.overview = cloud ? cloud->overview : nullptr;
    state.clipped = cloud && !cloud->whole.empty();
  }
  handoff.publish(std::move(snapshot));
  if (state.frames % kComparedFrames == 1) compare(source);
}

void Source::Inside::compare(const Source& source) {
  if (seams) seams->compare(place, source);
}

void Source::Inside::note(const Snapshot& snapshot) {
  note_surface(snapshot);
  ++state.frames;
  state.interval = state.frames > 1 ? builder->interval() : 0;
  state.latency = snapshot.start - snapshot.stamp;
  state.stamp = snapshot.stamp;
  state.fade = snapshot.fade;
}

void Source::Inside::note_surface(const Snapshot& snapshot) {
  points = snapshot.layers.empty() ? nullptr : snapshot.layers.back().points;
  state.points = points ? points->size() : 0;
  state.silent_from = snapshot.silent_from;
}

void Source::Inside::note(const SnapshotBuilder& made) {
  state.depth = made.median_depth();
  state.noise = made.noise().sigma(state.depth);
  state.correlation = made.noise().correlation;
}

void Source::publish(std::shared_ptr<const Snapshot> snapshot) {
  if (snapshot) check(inside_->name, *snapshot);
  {
    const std::lock_guard lock(inside_->mutex);
    inside_->points =
        snapshot && !snapshot->layers.empty() ? snapshot->layers.front().points : nullptr;
  }
  inside_->sight.forget();
  inside_->handoff.publish(std::move(snapshot));
  inside_->compare(*this);
}

std::shared_ptr<const SurfacePoints> Source::points() const {
  return inside_->copy(&Inside::points);
}

Source::State Source::state() const {
  return inside_->copy(&Inside::state);
}

}  // namespace palpate
