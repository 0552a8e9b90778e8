// Makes snapshots of the frames and clouds that are pushed into a source.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "prepare/place.hpp"
#include "scene/description.hpp"
#include "stream/streaming.hpp"

namespace palpate {
namespace {

// A cloud is clipped this far outside the fields' reach, of their radius: supports reach further
// than points, and normals look around (judgement).
constexpr double kClipMargin = 0.3;

// So many clouds in a row whose surfaces come late are no hiccup (judgement).
constexpr int kEnoughLate = 3;

// In so long at least a last surface goes to where all of what was measured has it, s (judgement).
constexpr double kLastMove = 0.1;

// Points of a cloud that are only seen: pages draw some ten thousand of all (judgement).
constexpr std::size_t kMostSeen = 20000;

// A sensor is silent no sooner than after so many intervals (judgement; docs/method.md 7.4).
constexpr double kSilentIntervals = 3;

const SourceOptions& checked(const SourceOptions& source) {
  for (const double radius : {source.prepare.minimum_radius, source.prepare.radius.value_or(0)}) {
    if (radius >= 0 && std::isfinite(radius)) continue;
    throw Error(fmt::format("invalid support radius of {} m; give a length in metres", radius));
  }
  check_described("policy", source.policy);
  return source;
}

/// The points of a cloud that preparation would take, by whether a tool can come to them before the
/// next clouds.
struct Split {
  std::vector<std::uint32_t> near;
  std::vector<std::uint32_t> far;
};

Split split(const PointCloud& cloud, const std::optional<Box>& clip, const Arrival& arrival) {
  Split parts;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d own = cloud.point(i);
    if (!own.allFinite() || (clip && !clip->contains(own))) continue;
    const Eigen::Vector3d p = arrival.T_world_sensor * own;
    const bool near = std::ranges::any_of(arrival.reach, [&](const Reach& reach) {
      return (p - reach.center).norm() <= (1 + kClipMargin) * reach.radius;
    });
    (near ? parts.near : parts.far).push_back(i);
  }
  return parts;
}

/// What is seen of these points, in the world frame. nullptr: there are none.
std::shared_ptr<const PointCloud> thinned(const PointCloud& cloud,
                                          std::span<const std::uint32_t> points,
                                          const Eigen::Isometry3d& T_world_sensor) {
  if (points.empty()) return nullptr;
  std::vector<std::uint32_t> kept;
  const std::size_t stride = (points.size() - 1) / kMostSeen + 1;
  for (std::size_t k = 0; k < points.size(); k += stride) kept.push_back(points[k]);
  return std::make_shared<const PointCloud>(place(select(cloud, kept), {}, T_world_sensor).cloud());
}

double time_of(const char* what, double time) {
  if (std::isfinite(time)) return time;
  throw Error(fmt::format("the {} of a frame or cloud is {}; give seconds", what, time));
}

}  // namespace

SnapshotBuilder::SnapshotBuilder(const SourceOptions& options)
    : options_(checked(options)),
      policies_{options.policy.policy.value_or(kDepthPolicy),
                options.policy.policy.value_or(kCloudPolicy)},
      filter_(options.depth),
      morph_({.silence = options.policy.silence,
              .fade = options.policy.fade,
              .kernel = options.prepare.kernel,
              .minimum_radius =
                  std::max(options.prepare.minimum_radius, options.prepare.radius.value_or(0))}),
      layers_(policies_.clouds, policies_.clouds == Policy::replace ? 1 : options.policy.history) {
  last_.presence_end = 0;  // there is none
}

std::size_t SnapshotBuilder::most_snapshots(bool clouds, std::size_t fields) const {
  const Policy policy = clouds ? policies_.clouds : policies_.frames;
  const bool weighs = policy == Policy::average || policy == Policy::crossfade;
  return (weighs ? static_cast<std::size_t>(options_.policy.history) : 1) + 2 + fields;
}

std::shared_ptr<Snapshot> SnapshotBuilder::take(const DepthFrame& frame, const Arrival& arrival) {
  time_of("stamp", frame.stamp);
  const bool everywhere = options_.policy.fit_everywhere;
  const FilteredDepth& depth = everywhere
                                   ? filter_.filter(frame, arrival.T_world_sensor)
                                   : filter_.filter(frame, arrival.T_world_sensor, arrival.reach);
  note_noise(depth);
  measured_.pinhole = frame.camera.pinhole;
  const MorphInput input{depth, measured_.pinhole, arrival.reach, everywhere};
  morph_.look(input);
  const FrameTiming moment = next_timing(frame.stamp, arrival.start);
  if (policies_.frames == Policy::morph) return morphed(input, moment);
  std::shared_ptr<Snapshot> snapshot = next_snapshot(moment, policies_.frames);
  std::shared_ptr<SurfacePoints> points = points_.take();
  morph_.fill_still(input, moment, points);
  layers_.add(std::move(points), moment, snapshot->layers);
  return snapshot;
}

std::shared_ptr<Snapshot> SnapshotBuilder::morphed(const MorphInput& input,
                                                   const FrameTiming& moment) {
  std::shared_ptr<Snapshot> snapshot = next_snapshot(moment, Policy::morph);
  std::shared_ptr<SurfacePoints> points = points_.take();
  morph_.fill(input, moment, points);
  snapshot->layers.push_back({std::move(points), 1, 1});
  return snapshot;
}

std::shared_ptr<Snapshot> SnapshotBuilder::last_of(const Snapshot& newest,
                                                   const CloudNotes& notes) {
  if (newest.sequence == 0 || newest.sequence != last_.sequence) return nullptr;
  const FrameTiming moment{last_.stamp, last_.end, std::max(kLastMove, last_.end - last_.start)};
  if (!notes.whole.empty()) {
    Prepared prepared = prepare(notes.whole, options_.prepare, notes.T_world_sensor);
    std::shared_ptr<SurfacePoints> points =
        filled(std::move(prepared), notes.whole, notes.T_world_sensor);
    std::shared_ptr<Snapshot> snapshot = next_snapshot(moment, policies_.clouds);
    for (const Snapshot::Layer& layer : newest.layers) {
      if (layer.weight_end > 0) snapshot->layers.push_back({layer.points, layer.weight_end, 0});
    }
    snapshot->layers.push_back({std::move(points), 0, 1});
    return snapshot;
  }
  if (policies_.frames != Policy::morph) return nullptr;
  const FilteredDepth* const depth = filter_.fit_all();
  if (depth == nullptr) return nullptr;
  const MorphInput input{.depth = *depth, .pinhole = measured_.pinhole, .last = true};
  morph_.look(input);
  return morphed(input, moment);
}

std::shared_ptr<Snapshot> SnapshotBuilder::take(const PointCloud& cloud, double stamp,
                                                const Arrival& arrival, CloudNotes& notes) {
  time_of("stamp", stamp);
  if (policies_.clouds == Policy::morph) {
    throw Error(
        "policy morph works only with depth frames; give replace, average or crossfade for clouds");
  }
  const bool clips =
      (options_.policy.clip_to_reach || clouds_.late == kEnoughLate) && !arrival.reach.empty();
  const Split parts = clips ? split(cloud, options_.prepare.clip, arrival) : Split{};
  const PointCloud clipped = select(cloud, parts.near);
  const PointCloud& wanted = clips ? clipped : cloud;
  notes = {.overview = thinned(cloud, parts.far, arrival.T_world_sensor),
           .whole = parts.far.empty() ? PointCloud() : cloud,
           .T_world_sensor = arrival.T_world_sensor};
  Prepared prepared;
  if (!clips || !wanted.empty()) {
    prepared = prepare(wanted, options_.prepare, arrival.T_world_sensor);
  }
  notes.report = prepared.report;
  std::shared_ptr<SurfacePoints> points =
      filled(std::move(prepared), cloud, arrival.T_world_sensor);
  const FrameTiming moment = next_timing(stamp, arrival.start);
  if (clouds_.late < kEnoughLate)
    clouds_.late = moment.start - stamp > kLateCloud ? clouds_.late + 1 : 0;
  std::shared_ptr<Snapshot> snapshot = next_snapshot(moment, policies_.clouds);
  layers_.add(std::move(points), moment, snapshot->layers);
  return snapshot;
}

/// The points of a cloud that was prepared, or a part of it was.
std::shared_ptr<SurfacePoints> SnapshotBuilder::filled(Prepared prepared, const PointCloud& cloud,
                                                       const Eigen::Isometry3d& T_world_sensor) {
  std::shared_ptr<SurfacePoints> points = points_.take();
  *points = std::move(prepared.points);
  points->eye = clouds_.view.eye_of(cloud, options_.prepare, T_world_sensor);
  return points;
}

FrameTiming SnapshotBuilder::next_timing(double stamp, const Source::StartTime& start) {
  const FrameTiming moment = interval_filter_.next(stamp, time_of("start", start()));
  if (presence_at(moment.start) <= 0) forget();
  return moment;
}

/// A snapshot without layers. Presence goes on from where the last one's is at its start.
std::shared_ptr<Snapshot> SnapshotBuilder::next_snapshot(const FrameTiming& moment, Policy policy) {
  const bool moving = policy != Policy::replace && policy != Policy::average;
  const double fade = options_.policy.fade;
  const bool first = presence_at(moment.start) <= 0;
  std::shared_ptr<Snapshot> snapshot = snapshots_.take();
  Snapshot& s = *snapshot;
  s.start = moment.start;
  s.end = moment.start + (moving ? moment.duration : 0);
  // Under morph what was not there before fades in point by point.
  s.presence_start = first ? (policy == Policy::crossfade ? 0 : 1) : presence_at(moment.start);
  s.presence_end = first ? 1 : std::min(1.0, s.presence_start + moment.duration / fade);
  s.silent_from =
      moment.start + std::max(options_.policy.silence, kSilentIntervals * moment.duration);
  s.fade = fade;
  s.interval = moment.duration;
  s.spare = moment.spare;
  s.stamp = moment.stamp;
  s.sequence = last_.sequence + 1;
  last_ = s;
  return snapshot;
}

double SnapshotBuilder::presence_at(double time) const {
  return last_.sequence == 0 ? 0 : presence(last_, time);
}

void SnapshotBuilder::forget() {
  morph_.forget();
  layers_.forget();
}

/// Keeps the noise model and the median depth of the image.
void SnapshotBuilder::note_noise(const FilteredDepth& depth) {
  constexpr std::size_t kStep = 37;  // a sample is enough
  std::vector<float>& depths = measured_.depths;
  measured_.noise = depth.noise;
  depths.clear();
  for (std::size_t b = 0; b < depth.size(); b += kStep) {
    if (depth.states[b] != FilteredDepth::State::empty) depths.push_back(depth.positions[b].z());
  }
  if (depths.empty()) return;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  measured_.median_depth = static_cast<double>(*middle);
}

}  // namespace palpate
