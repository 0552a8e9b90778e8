// Follows the snapshots of one source in time, as one reader sees them.
#include "scene/source_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// A snapshot that starts later than this is a mistake of clocks, s (judgement).
constexpr double kPatience = 1;

// A surface that has faded away stays so long without any stiffness: proxies let their springs
// follow it with a delay (EnergyTank::kTime, a fifth of this). s (derived)
constexpr double kLinger = 0.1;

// The time in which its weights fade then, s (judgement).
constexpr double kLeave = 0.3;

// A late snapshot catches up within this share of its duration, and more the later it is.
constexpr double kCatchUp = 0.25;
constexpr double kCatchUpMore = 0.5;  // judgement, both

}  // namespace

SnapshotReader::SnapshotReader(Handoff<Snapshot>& handoff, const std::string& name)
    : handoff_(&handoff), reader_(handoff.join(name)) {
  if (reader_ == Handoff<Snapshot>::kReaders) {
    throw Error(fmt::format("the scene already has {} fields; destroy one before creating another",
                            Handoff<Snapshot>::kReaders));
  }
}

SnapshotReader::~SnapshotReader() {
  handoff_->leave(reader_);
}

bool SnapshotReader::advance(double now) noexcept {
  look(now);
  if (!next_ || (current_ && now < next_->start)) return false;
  handoff_->release(reader_, slot_);
  slot_ = 1 - slot_;
  current_ = next_;
  next_ = nullptr;
  return true;
}

void SnapshotReader::look(double now) noexcept {
  const Snapshot* newest = handoff_->peek();
  if (newest == current_ && !next_) return;
  if (newest && (newest == current_ || newest == next_)) return;
  if (!newest) {
    handoff_->release(reader_, slot_);
    handoff_->release(reader_, 1 - slot_);
    current_ = next_ = nullptr;
    return;
  }
  if (next_ && next_->start - now <= kPatience) return;
  next_ = handoff_->acquire(reader_, 1 - slot_);
  if (next_) taken_ = next_->publication;
}

bool SourceView::advance(double now) noexcept {
  const Snapshot* const snapshot_before = snapshots_.current();
  const Times before = snapshot_before ? Times{snapshot_before->start, snapshot_before->end,
                                               snapshot_before->sequence}
                                       : Times{};
  const double progress_before = progress_;
  const double share_before = share_;
  const double radius_before = std::exchange(least_radius_, wanted_radius_->load());
  if (snapshots_.advance(now)) begin(before);
  move(now);
  fade(now, now - shown_);
  shown_ = now;
  return snapshots_.current() != snapshot_before || progress_ != progress_before ||
         share_ != share_before || least_radius_ != radius_before;
}

/// Finds how far the points have gone. The lag that a snapshot began with shrinks in a straight
/// line.
void SourceView::move(double now) noexcept {
  const Snapshot* const shown = snapshots_.current();
  progress_ = shown ? progress(*shown, now) : 0;
  const double duration = shown ? shown->end - shown->start : 0;
  rate_ = duration > 0 && progress_ > 0 && progress_ < 1 ? 1 / duration : 0;
  const double left = 1 - (now - begun_) / catch_up_;
  if (!(lag_ > 0) || left <= 0) return;
  progress_ = std::max(0.0, progress_ - lag_ * std::min(left, 1.0));
  if (progress_ < 1) rate_ += lag_ / catch_up_;
}

void SourceView::fade(double now, double dt) noexcept {
  const Snapshot* const shown = snapshots_.current();
  const double wanted = shown ? palpate::presence(*shown, now) : 0;
  const double duration = shown ? shown->end - shown->start : 0;
  const double rise = duration > 0 ? (shown->presence_end - shown->presence_start) / duration : 0;
  const bool rises = shown && share_ > 0 && wanted > presence_ && shown->fade > 0;
  // A step from one snapshot to the next is made as slowly as a surface fades; the presence
  // within a snapshot is followed.
  const double rate = rises ? std::max(1 / shown->fade, rise) : 0;
  presence_ = rises ? std::min(wanted, presence_ + std::max(dt, 0.0) * rate) : wanted;
  faded_ = presence_ > 0 ? 0 : share_ > 0 ? faded_ + std::max(dt, 0.0) : faded_;
  share_ = !shown          ? 0
           : presence_ > 0 ? 1
           : share_ > 0    ? std::clamp(1 - (faded_ - kLinger) / kLeave, 0.0, 1.0)
                           : 0;
}

/// Begins a snapshot. One that was published after its start begins where the surface is and
/// catches up. Its lag is less by the part of A to B that the old surface has moved since then.
void SourceView::begin(const Times& before) noexcept {
  const Snapshot& shown = *snapshots_.current();
  const bool same = before.sequence > 0 && before.sequence == shown.sequence;
  if (same && before.start == shown.start) return;  // the one that was shown, kept on
  begun_ = shown_;
  lag_ = 0;
  const double duration = shown.end - shown.start;
  const double delay = shown_ - shown.start;
  if (!(delay > 0) || !(duration > 0)) return;
  const double span = before.end - before.start;
  const double left = span > 0 ? std::clamp((before.end - shown.start) / span, 0.0, 1.0) : 0;
  const double gone = span > 0 ? std::min(delay / span, left) / (1 + left) : 0;
  lag_ = std::clamp(delay / duration - gone, 0.0, 1.0);
  catch_up_ = duration * (kCatchUp + kCatchUpMore * lag_);
}

bool SourceView::misses(const Ball& ball) const noexcept {
  const Snapshot* const snapshot = current();
  return snapshot != nullptr && std::ranges::any_of(snapshot->missing, [&](const Box& box) {
           const Eigen::Vector3d nearest = ball.center.cwiseMax(box.lower).cwiseMin(box.upper);
           return (ball.center - nearest).squaredNorm() < ball.radius * ball.radius;
         });
}

ActiveLayer SourceView::layer(std::size_t k, int source) const noexcept {
  const Snapshot::Layer& layer = snapshots_.current()->layers[k];
  const double weight = layer.weight_start + progress_ * (layer.weight_end - layer.weight_start);
  return {.points = layer.points.get(),
          .source = source,
          .weight = share_ * weight,
          .progress = progress_,
          .rate = rate_,
          .until = 1,
          .least_radius = least_radius_};
}

double time_stepped(const Snapshot& snapshot, std::span<const ActiveLayer> before) noexcept {
  const auto is_new = [before](const Snapshot::Layer& layer) {
    const auto same = [&](const ActiveLayer& shown) { return shown.points == layer.points.get(); };
    return layer.weight_start > 0 && layer.points->end_positions.empty() &&
           std::ranges::none_of(before, same);
  };
  return std::ranges::any_of(snapshot.layers, is_new) ? time_shown(snapshot) : 0;
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

void ActiveLayers::clear() noexcept {
  count = 0;
  least_typical = std::numeric_limits<double>::infinity();
  cloud_duration = 0;
  frame_interval = 0;
  other_kernel = false;
  moving = false;
  plain_points = true;
}

void ActiveLayers::add(const SourceView& view, int source, const FieldOptions& options) noexcept {
  const Snapshot* newest = view.current();
  for (std::size_t k = 0; newest && k < newest->layers.size(); ++k) {
    ActiveLayer layer = view.layer(k, source);
    const bool still = layer.points->end_positions.empty();
    frame_interval = std::max(frame_interval, still ? time_to_next(*newest) : time_shown(*newest));
    if (layer.points->size() == 0) continue;  // a sensor that sees nothing
    if (options.kind == FieldOptions::Kind::metaball) layer.least_radius = 0;
    if (still) cloud_duration = std::max(cloud_duration, time_shown(*newest));
    layer.last_weight = newest->layers[k].weight_end;
    other_kernel = other_kernel || layer.points->kernel != options.kernel;
    least_typical = std::min(least_typical, std::max(layer.points->radius, layer.least_radius));
    moving = moving || layer.rate > 0;
    plain_points &= !moving && layer.points->materials.empty() && !fades(*layer.points);
    layers[count++] = layer;
  }
}

}  // namespace palpate
