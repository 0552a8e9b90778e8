// Takes frames and clouds that come one after another, has snapshots made of them, and hands these
// over to readers.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prepare/place.hpp"
#include "stream/streaming.hpp"

namespace palpate {
namespace {

// How sources disagree changes slowly, and takes milliseconds to measure: frames between
// two looks (judgement).
constexpr std::uint64_t kComparedFrames = 32;

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

bool measures_nothing(const DepthFrame& frame) {
  return std::ranges::none_of(frame.depth, [](float z) { return std::isfinite(z) && z > 0; });
}

void note_noise(const SnapshotBuilder& made, Source::State& state) {
  state.depth = made.median_depth();
  state.noise = made.noise().sigma(state.depth);
  state.correlation = made.noise().correlation;
}

}  // namespace

std::shared_ptr<Streaming> make_streaming(const SourceOptions& options) {
  return std::make_shared<Streaming>(options);
}

void forget_frames(Streaming* streaming) {
  streaming->sight.forget();
}

bool set_as_frame(Source& source, const PointCloud& cloud) {
  const SourceOptions wanted = source.options();
  if (!wants_image(cloud, wanted)) return false;
  OrganisedFrame image = depth_frame_of(cloud);
  if (!image.frame || !is_mostly_felt(*image.frame, wanted.depth)) return false;
  auto& pose_in_cloud = image.frame->T_world_sensor;
  pose_in_cloud = source.pose() * pose_in_cloud.value_or(Eigen::Isometry3d::Identity());
  source.set(*image.frame);
  return true;
}

std::optional<SurfaceEye> eye_of(const PointCloud& cloud, const PrepareOptions& options,
                                 const Eigen::Isometry3d& T_world_sensor) {
  return OneView{}.eye_of(cloud, options, T_world_sensor);
}

Streaming::Streaming(const SourceOptions& options)
    : builder(std::make_unique<SnapshotBuilder>(options)) {}

Streaming& Streaming::of(const Source& source) {
  return *source.inside_->streaming;
}

void Source::change(const SourceOptions& options) {
  std::unique_ptr<SnapshotBuilder> changed;
  named(inside_->name, [&] { changed = std::make_unique<SnapshotBuilder>(options); });
  const std::lock_guard lock(inside_->mutex);
  inside_->streaming->changed = std::move(changed);
  inside_->options.prepare = options.prepare;
  inside_->options.policy = options.policy;
  inside_->options.depth = options.depth;
  inside_->options.organised = options.organised;
}

void Streaming::take_change(const Source::Inside& source) {
  const std::lock_guard lock(source.mutex);
  if (!changed) return;
  builder = std::move(changed);
  taken = source.options;
  ++changes;
}

void Source::set(const DepthFrame& frame) {
  SourceOptions whole = options();
  whole.policy = {.fit_everywhere = true};
  const Source::StartTime at_once = [] { return 0.0; };
  const Eigen::Isometry3d stand = frame.T_world_sensor.value_or(pose());
  auto snapshot = std::make_shared<Snapshot>();
  NoiseModel noise;
  Streaming& streaming = *inside_->streaming;
  named(inside_->name, [&] {
    check_pose(stand);
    SnapshotBuilder builder(whole);
    snapshot->layers = builder.take(frame, {stand, {}, at_once})->layers;
    noise = builder.noise();
    const std::lock_guard lock(inside_->mutex);
    inside_->state = {};
    streaming.note(*snapshot, *inside_);
    note_noise(builder, inside_->state);
  });
  snapshot->publication = ++inside_->publications;
  publish(std::move(snapshot));
  streaming.sight.see(frame, stand, noise);
  streaming.stays = true;
}

bool Source::push(const DepthFrame& frame, const Source::StartTime& start) {
  Streaming& streaming = *inside_->streaming;
  streaming.take_change(*inside_);
  streaming.stays = false;
  streaming.notes = {};
  const Eigen::Isometry3d pose_now = frame.T_world_sensor.value_or(pose());
  named(inside_->name, [&] {
    if (frame.T_world_sensor) check_pose(pose_now);
    if (streaming.watched) streaming.show(frame, pose_now);
  });
  if (measures_nothing(frame)) return true;
  if (!streaming.room_for(false, *inside_)) return false;
  inside_->reaches.read(streaming.found);
  named(inside_->name, [&] {
    const Arrival arrival{pose_now, streaming.found, start};
    streaming.hand_over(streaming.builder->take(frame, arrival), nullptr, *this);
  });
  const std::lock_guard lock(inside_->mutex);
  note_noise(*streaming.builder, inside_->state);
  return true;
}

bool Source::push(const PointCloud& cloud, double stamp, const Source::StartTime& start) {
  Streaming& streaming = *inside_->streaming;
  streaming.take_change(*inside_);
  streaming.sight.forget();
  if (!streaming.room_for(true, *inside_)) return false;
  inside_->reaches.read(streaming.found);
  CloudNotes& notes = streaming.notes;
  named(inside_->name, [&] {
    const Arrival arrival{pose(), streaming.found, start};
    streaming.hand_over(streaming.builder->take(cloud, stamp, arrival, notes), &notes, *this);
  });
  return true;
}

void Source::keep() {
  const Snapshot* newest = inside_->handoff.peek();  // nobody else publishes, so nobody frees it
  if (newest == nullptr) return;
  Streaming& streaming = *inside_->streaming;
  std::shared_ptr<Snapshot> kept = streaming.room_for(false, *inside_)
                                       ? streaming.builder->last_of(*newest, streaming.notes)
                                       : nullptr;
  const bool whole = kept != nullptr;
  if (!whole) kept = std::make_shared<Snapshot>(*newest);
  kept->silent_from = std::numeric_limits<double>::infinity();
  kept->publication = ++inside_->publications;
  {
    const std::lock_guard lock(inside_->mutex);
    Streaming::note_surface(*kept, *inside_);
    if (whole) inside_->state.overview = nullptr;
  }
  inside_->handoff.publish(std::move(kept));
}

bool Streaming::room_for(bool clouds, Source::Inside& source) {
  Handoff<Snapshot>& handoff = source.handoff;
  const std::size_t most = builder->most_snapshots(clouds, handoff.readers());
  if (handoff.alive() < most) return true;
  handoff.sweep();
  if (handoff.alive() < most) return true;
  std::string slowest = handoff.slowest();
  const std::lock_guard lock(source.mutex);
  ++source.state.dropped;
  source.state.slowest = std::move(slowest);
  return false;
}

void Streaming::hand_over(std::shared_ptr<Snapshot> snapshot, const CloudNotes* cloud,
                          const Source& source) {
  Source::Inside& to = *source.inside_;
  snapshot->publication = ++to.publications;
  {
    const std::lock_guard lock(to.mutex);
    note(*snapshot, to);
    if (cloud) to.report = cloud->report;
    to.state.overview = cloud ? cloud->overview : nullptr;
    to.state.clipped = cloud && !cloud->whole.empty();
  }
  to.handoff.publish(std::move(snapshot));
  if (to.state.frames % kComparedFrames == 1) to.slot.compare(source);
}

void Streaming::note_surface(const Snapshot& snapshot, Source::Inside& source) {
  source.points = snapshot.layers.empty() ? nullptr : snapshot.layers.back().points;
  source.state.points = source.points ? source.points->size() : 0;
  source.state.silent_from = snapshot.silent_from;
}

void Streaming::note(const Snapshot& snapshot, Source::Inside& source) const {
  note_surface(snapshot, source);
  Source::State& state = source.state;
  ++state.frames;
  state.interval = state.frames > 1 ? builder->interval() : 0;
  state.latency = snapshot.start - snapshot.stamp;
  state.stamp = snapshot.stamp;
  state.fade = snapshot.fade;
}

}  // namespace palpate
