// Lists the segments near the tool and their points, and sums what the eye sees of them.

#include "field/segment_view.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "field/formulas.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Component = SegmentTable::Component;
using Segment = SegmentTable::Segment;
using Point = SegmentView::Point;

// A component keeps its sign while one of its points is within kHolds, a segment its label within
// kMeets. Both are above 1 R, where weights end. Labels are settled later, with more evidence.
constexpr float kHolds = 1.5f;  // R; judgement
constexpr float kMeets = 1.1f;  // R; judgement

// What the eye sees (docs/method.md 2.7); all are judgement.
constexpr float kView = 1.2f;  // R beyond the nearest point, within which points count
constexpr double kFades = 1;   // R of travel on which what was seen fades to a third
// R from a surface within which a known side counts. Measured: in creases it is up to 0.08 R high.
constexpr double kDoubt = 0.1;

/// The index of a component, which is added if it is new. Components are never more than segments,
/// so there is room for them.
std::uint32_t add_component(std::vector<Component>& components, Component component,
                            const SegmentTable& before) noexcept {
  for (std::size_t k = components.size(); k-- > 0;) {
    if (components[k].key == component.key) return static_cast<std::uint32_t>(k);
  }
  for (const Component& old : before.components) {
    if (old.key != component.key) continue;
    component.sign = old.sign;
    component.assumed = old.assumed;
    if (old.weighs) component.seen = old.seen;
  }
  components.push_back(component);
  return static_cast<std::uint32_t>(components.size() - 1);
}

/// Has the segment a label, and is it seen from its one side? Then what is seen of it decides
/// nothing.
bool is_decided(const Segment& segment, const Component& component) noexcept {
  return segment.label != SegmentTable::kUndecided && component.is_one_sided() &&
         component.sign > 0;
}

void list_layer(SegmentView& view, const ActiveLayer& layer, std::span<const std::uint32_t> indices,
                const Stance& stance) noexcept {
  const auto spread = static_cast<float>(stance.spread);
  const SurfacePoints& surface = *layer.points;
  const SurfacePoints::Segments& own = surface.segments;
  const std::uint32_t none = surface.one_sided() ? SegmentView::kUncertain : SegmentView::kNone;
  std::uint32_t last = SurfacePoints::Segments::kNone;
  std::uint32_t slot = SegmentView::kNone;
  for (const std::uint32_t i : indices) {
    const double confidence = surface.normals.empty() ? 0 : confidence_now(layer, i);
    const std::uint32_t segment = own.empty() ? 0 : own.segment[i];
    if (confidence <= 0 || segment == SurfacePoints::Segments::kNone) {
      view.segment_of_point.push_back(none);
      continue;
    }
    if (segment != last) slot = view.table.add(layer, last = segment, view.before);
    view.segment_of_point.push_back(slot == SegmentView::kNone ? none : slot);
    if (slot == SegmentView::kNone) continue;
    Point point{};
    point.position = position_now(layer, i, stance.proxy).cast<float>();
    point.normal = normal_now(layer, i).cast<float>();
    point.confidence = static_cast<float>(confidence);
    point.radius = static_cast<float>(radius_now(layer, i));
    point.segment = slot;
    point.residual = own.empty() ? 0 : own.residual[i];
    view.points.push_back(point);
    Segment& s = view.table.segments[slot];
    const float distance = point.position.norm();
    Component& component = view.table.components[s.component];
    // A component that all points share keeps its side until free space.
    component.near |=
        own.empty() || component.is_one_sided() || distance <= kHolds * point.radius + spread;
    component.weighs |= distance <= point.radius;
    if (own.empty() || distance <= kMeets * point.radius + spread) s.near = true;
    ++s.count;
  }
}

void group(SegmentView& view) noexcept {
  std::uint32_t begin = 0;
  for (Segment& segment : view.table.segments) {
    segment.begin = begin;
    begin += segment.count;
    segment.count = 0;
  }
  view.order.resize(view.points.size());
  for (std::uint32_t i = 0; i < view.points.size(); ++i) {
    Segment& segment = view.table.segments[view.points[i].segment];
    view.order[segment.begin + segment.count++] = i;
  }
}

/// The height of the surface above a point, m.
float rise_of(const SegmentView& view, const Point& point) noexcept {
  return static_cast<float>(view.rise.length + view.rise.share * static_cast<double>(point.radius));
}

/// How high the eye is above the surface at a point, m. What was seen from one side alone is never
/// turned, and close above a bulge the planes of most of its points are higher than the eye: half
/// of the closest point's vote keeps these down.
float height_over(const SegmentView& view, const Point& point) noexcept {
  const Vector3f offset = view.eye.position - point.position;
  const float height = point.normal.dot(offset);
  const bool bent = view.is_one_sided(point) && point.normal.dot(view.eye.beside) > 0.5f;
  return bent ? 0.5f * (height + view.eye.beside.dot(offset)) : height;
}

/// The tool looks from where it is or, where it touches, from a little above.
void choose_eye(SegmentView& view, const Stance& stance) noexcept {
  const float lift = stance.touches() ? kLift * view.radius : 0;
  view.eye.position = lift * stance.normal.cast<float>();
  float closest = std::numeric_limits<float>::infinity();
  float closest_seen = closest;
  for (const Point& point : view.points) {
    const float squared = (point.position - view.eye.position).squaredNorm();
    closest = std::min(closest, squared);
    if (!view.is_one_sided(point) || squared >= closest_seen) continue;
    closest_seen = squared;
    view.eye.beside = point.normal;
  }
  view.eye.view = std::sqrt(closest) + kView * view.radius;
}

/// The balanced surface of a component around the eye (docs/method.md 2.4).
struct Balanced {
  double weight = 0, heights = 0;  // heights: of the eye over the points' planes
  Vector3d normals = Vector3d::Zero();
  Vector3d backs = Vector3d::Zero();  // from the points to the eye

  void add(const Point& point, const Vector3f& back, float squared) noexcept {
    const double w = static_cast<double>(point.confidence) * weight_within(squared, point.radius);
    weight += w;
    heights += w * static_cast<double>(point.normal.dot(back));
    normals += w * point.normal.cast<double>();
    backs += w * back.cast<double>();
  }
  /// What speaks for the side of the normals, in R: the eye's, or within kDoubt the known one.
  [[nodiscard]] double seen(bool known, double radius) const noexcept {
    const double height = 0.5 * (heights + normals.dot(backs) / weight) / radius;
    return known && std::abs(height) < kDoubt * weight ? kDoubt * weight : height;
  }
};

}  // namespace

SegmentTable::SegmentTable() {
  components.reserve(kMost);
  segments.reserve(kMost);
  clear();
}

void SegmentTable::clear_segments() noexcept {
  segments.clear();
  slots.fill(kMost);
}

void SegmentTable::clear() noexcept {
  components.clear();
  clear_segments();
}

void SegmentTable::make_near_face(std::uint8_t touched) noexcept {
  const auto any = [this](std::uint8_t label) {
    return std::ranges::any_of(segments,
                               [=](const Segment& segment) { return segment.label == label; });
  };
  const bool concave = any(kConcave);
  const std::uint8_t left = concave ? kConcave : kFarFace;
  const std::uint8_t first = any(kNearFace) ? touched : left;
  if (first == kNearFace || (first == kFarFace && concave)) return;
  swap_labels(segments, kNearFace, first);
}

std::uint8_t SegmentTable::find(const Key& key) const noexcept {
  auto at = static_cast<std::uint8_t>((key.number * 2654435761u) >> 24);
  while (slots[at] < kMost && segments[slots[at]].key != key) ++at;
  return at;
}

std::uint32_t SegmentTable::add(const ActiveLayer& layer, std::uint32_t number,
                                const SegmentTable& before) noexcept {
  const SurfacePoints& points = *layer.points;
  const SurfacePoints::Segments& own = points.segments;
  const Key key = own.empty() ? key_of_all(points) : Key{&points, number};
  std::uint8_t& slot = slots[find(key)];
  if (slot < kMost || segments.size() == kMost) return slot;
  Component component{.key = key_of_all(points),
                      .outward = own.empty() || own.known[own.component[number]] != 0};
  component.uncertain = points.one_sided() && !component.outward;
  if (!own.empty() && (component.uncertain || !points.one_sided()))
    component.key = {&points, own.component[number]};
  Segment segment{.key = key,
                  .source = layer.source,
                  .component = add_component(components, component, before)};
  const std::uint8_t old = before.slots[before.find(key)];
  if (old < kMost) segment.label = before.segments[old].label;
  slot = static_cast<std::uint8_t>(segments.size());
  segments.push_back(segment);
  return slot;
}

SegmentView::SegmentView(std::size_t capacity) {
  points.reserve(capacity);
  segment_of_point.reserve(capacity);
  order.reserve(capacity);
}

void SegmentView::list(std::span<const ActiveLayer> layers, const Selection& chosen,
                       const Rise& height, const Stance& stance) noexcept {
  rise = height;
  std::swap(before, table);
  table.clear();
  points.clear();
  segment_of_point.clear();
  for (std::size_t k = 0; k < layers.size(); ++k) {
    list_layer(*this, layers[k], chosen.indices(chosen.runs()[k]), stance);
  }
  float radii = 0;
  for (const Point& point : points) radii += point.radius;
  if (!points.empty()) radius = radii / static_cast<float>(points.size());
  group(*this);
}

std::uint8_t SegmentView::touched_label(const Vector3f& normal) const noexcept {
  if (normal.isZero(0)) return kNearFace;
  std::array<double, simd::kLabels> touched{};
  for (const Point& p : points) {
    const Segment& segment = table.segments[p.segment];
    const auto sign = static_cast<float>(table.components[segment.component].factor());
    const float cosine = sign * p.normal.dot(normal);
    if (segment.label == SegmentTable::kUndecided || cosine <= 0) continue;
    touched[segment.label] +=
        static_cast<double>(cosine) * weight_within(p.position.squaredNorm(), p.radius);
  }
  return static_cast<std::uint8_t>(std::ranges::max_element(touched) - touched.begin());
}

bool SegmentView::has_lost_one() const noexcept {
  return std::ranges::any_of(before.segments, [this](const Segment& old) {
    return old.near && table.slots[table.find(old.key)] == kNone;
  });
}

bool SegmentView::is_above(const Point& point) const noexcept {
  return height_over(*this, point) >= rise_of(*this, point);
}

/// Sums what speaks for the sides that the eye sees: close to points their surface, as the planes
/// of most are higher than an eye close to a bulge. What was seen on the path here counts less the
/// longer it is: close to a sparse bend few points show a side, and the planes of some are wrong.
void SegmentView::look(const Stance& stance, double travel, bool from_behind) noexcept {
  const auto decided = [this](const Segment& segment) {
    return is_decided(segment, table.components[segment.component]);
  };
  if (std::ranges::all_of(table.segments, decided)) return;
  choose_eye(*this, stance);
  const double kept = std::exp(-travel / (kFades * static_cast<double>(radius)));
  std::array<double, kNone> seen{};
  std::array<Balanced, kNone> around{};
  for (const Point& p : points) {
    Segment& segment = table.segments[p.segment];
    if (decided(segment)) continue;
    const Vector3f back = eye.position - p.position;
    const float squared = back.squaredNorm();
    if (squared >= eye.view * eye.view) continue;
    const float height = height_over(*this, p);
    const double w = static_cast<double>(p.confidence) * weight_within(squared, eye.view);
    segment.weight += w;
    const float length = std::max(std::sqrt(squared), 1e-12f);
    // A proxy that comes from behind is in front only above the surface, not above its points.
    const float over = from_behind && is_one_sided(p) ? height - rise_of(*this, p) : height;
    const double sharp = std::max(0.f, std::abs(over) - kUnsharp * p.residual) / length;
    seen[segment.component] += w * sharp * (over < 0 ? -1 : 1);
    if (squared < p.radius * p.radius) around[segment.component].add(p, back, squared);
  }
  for (std::size_t k = 0; k < table.components.size(); ++k) {
    Component& component = table.components[k];
    if (around[k].weight > 0 && !component.is_one_sided())
      seen[k] = around[k].seen(component.outward, static_cast<double>(radius));
    const bool fades = component.seen != 0 && !component.is_one_sided();
    component.seen = fades ? kept * component.seen + (1 - kept) * seen[k] : seen[k];
  }
}

}  // namespace palpate
