// Keeps what is decided of the segments near the tool from one call to the next.

#include "field/facing.hpp"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr int kPairs = 2048;  // compared in one call, to bound its time; judgement

/// Forgets the sign of a component without weight at the proxy, or that a free proxy is behind, and
/// the label of a segment that has moved away. The next position of a tool may be elsewhere, so it
/// forgets what nothing speaks for.
void let_go(SegmentTable& table, const Stance& stance) noexcept {
  for (SegmentTable::Component& component : table.components) {
    const bool behind = component.is_absent() && !stance.touches();
    const bool unknown = component.assumed && stance.spread > 0;
    if (!component.near || behind || unknown) component.sign = 0;
  }
  for (SegmentTable::Segment& segment : table.segments) {
    if (!segment.near) segment.label = SegmentTable::kUndecided;
  }
}

}  // namespace

void AgreedSides::begin_update(double passed) noexcept {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    Side side = sides_[k];
    side.unconfirmed += passed;
    if (side.unconfirmed <= kKept) sides_[kept++] = side;
  }
  count_ = kept;
}

AgreedSides::Side* AgreedSides::find(const Component& component) noexcept {
  // Points that were seen from one side alone are never turned.
  if (component.is_one_sided()) return nullptr;
  const auto all = std::span(sides_).first(count_);
  const auto found = std::ranges::find(all, component.key, &Side::component);
  return found == all.end() ? nullptr : &*found;
}

void AgreedSides::turn(std::span<Component> components) noexcept {
  for (Component& component : components) {
    if (const Side* side = find(component)) component.sign = side->sign;
  }
}

void AgreedSides::confirm(std::span<const Component> components) noexcept {
  for (const Component& component : components) {
    const bool decided = component.sign != 0 && !component.assumed;
    if (component.is_one_sided() || !decided || !component.near) continue;
    if (Side* side = find(component)) {
      if (side->sign == component.sign) side->unconfirmed = 0;
    } else if (count_ < sides_.size()) {
      sides_[count_++] = {component.key, component.sign, 0};
    }
  }
}

Facing::Facing(std::size_t capacity) : view_(capacity) {
  references_.reserve(2 * capacity);
  remembered_.reserve(2 * capacity);
}

void Facing::forget() noexcept {
  view_.table.clear();
  remembered_.clear();
}

void Facing::reopen() noexcept {
  view_.table.clear_segments();
  for (Component& component : view_.table.components) component.sign = 0;
  remembered_.clear();
}

void Facing::follow(const Facing& other) noexcept {
  follows_ = true;
  touched_ = other.touched_;
  was_behind_ = other.was_behind_;
  if (other.view_.table.components.empty()) return;
  view_.table = other.view_.table;  // within what was reserved
  remembered_ = other.remembered_;
  remembered_from_ = other.remembered_from_;
}

void Facing::add_references(const Segment& segment) noexcept {
  const Component& component = view_.table.components[segment.component];
  const int sign = component.factor();
  if (segment.label == SegmentTable::kUndecided || sign == 0) return;
  for (std::uint32_t k = 0; k < segment.count; ++k) {
    const Point& p = view_.points[view_.order[segment.begin + k]];
    if (references_.size() == references_.capacity()) return;
    if (component.is_absent() && !view_.is_above(p)) continue;
    references_.push_back({segment.key.owner, segment.source, p.position,
                           static_cast<float>(sign) * p.normal, p.confidence, p.residual,
                           segment.label});
  }
}

/// Lists all points that are decided. Where another cloud replaced one (`vanished`), the points
/// remembered of it are among them, for what is there instead now.
void Facing::list_references(const Eigen::Vector3d& proxy, bool vanished) noexcept {
  references_.clear();
  if (vanished) {
    const Vector3f shift = (remembered_from_ - proxy).cast<float>();
    for (Reference r : remembered_) {
      r.position += shift;
      r.cloud = nullptr;
      references_.push_back(r);
    }
  }
  for (const Segment& segment : view_.table.segments) add_references(segment);
}

/// Are all points of one component whose side is decided, so that nothing needs a look?
bool Facing::is_settled(std::span<const ActiveLayer> layers) const noexcept {
  const SegmentTable& table = view_.table;
  if (table.segments.size() != 1 || table.segments[0].label != kNearFace ||
      table.sees_from_behind()) {
    return false;
  }
  return std::ranges::all_of(layers, [&](const ActiveLayer& layer) {
    return layer.points->segments.empty() &&
           table.segments[0].key == SegmentTable::key_of_all(*layer.points);
  });
}

void Facing::look(const Points& points, const Stance& stance) noexcept {
  pairs_ = kPairs;
  view_.list(points.layers, *points.selection, points.rise, stance);
  if (view_.points.empty()) return;
  if (!std::exchange(follows_, false)) let_go(view_.table, stance);
  view_.look(stance, (stance.proxy - remembered_from_).norm(), was_behind_);
  const bool begins = stance.touches() && !touched_;
  touched_ = stance.touches();
  if (begins) turn_by(stance.normal.cast<float>());
  view_.table.make_near_face(view_.touched_label(stance.normal.cast<float>()));
  const auto older = static_cast<std::ptrdiff_t>(remembered_.size());
  const bool vanished = view_.has_lost_one();
  list_references(stance.proxy, vanished);
  if (stance.agreed) stance.agreed->turn(view_.table.components);
  decide_signs(stance.touches() || vanished);
  if (stance.agreed) confirm(*stance.agreed);
  decide_labels();
  if (vanished) references_.erase(references_.begin(), references_.begin() + older);
  std::swap(references_, remembered_);
  remembered_from_ = stance.proxy;
}

/// Do the points near decide whether the proxy is behind them? Points of one view whose side is
/// undecided do not: for a proxy behind them they count for nothing.
bool Facing::decides() const noexcept {
  const std::vector<Component>& components = view_.table.components;
  return std::ranges::any_of(components, &Component::is_one_sided) ||
         (std::ranges::none_of(components, &Component::uncertain) &&
          std::ranges::count(view_.segment_of_point, SegmentView::kUncertain) == 0);
}

bool Facing::write(const Points& points) const noexcept {
  const std::vector<std::uint32_t>& segments = view_.segment_of_point;
  bool changed = false;
  std::size_t next = 0;  // of the points in view
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const std::uint32_t slot = segments[k];
    std::int8_t sign = 1;
    bool uncertain = slot == SegmentView::kUncertain;  // of one view, with no side of its own
    std::uint8_t label = kNearFace;
    if (slot < SegmentView::kNone) {
      const Segment& segment = view_.table.segments[slot];
      const Component& component = view_.table.components[segment.component];
      sign = static_cast<std::int8_t>(component.sign);
      uncertain = component.uncertain;
      label = segment.label;
      if (component.is_absent()) sign = view_.is_above(view_.points[next]) ? 1 : 0;
      ++next;
    }
    if (uncertain && was_behind_) sign = 0;
    changed = changed || points.signs[k] != sign || points.labels[k] != label;
    points.signs[k] = sign;
    points.labels[k] = label;
  }
  return changed;
}

bool Facing::face(const Points& points, const Stance& stance) noexcept {
  if (is_settled(points.layers)) {
    view_.segment_of_point.assign(points.signs.size(), 0);
  } else {
    look(points, stance);
  }
  if (decides()) was_behind_ = view_.table.sees_from_behind();
  return write(points);
}

}  // namespace palpate
