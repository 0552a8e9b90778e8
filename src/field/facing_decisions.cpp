// Decides the signs of components that come into view, and the labels of their segments.

#include <algorithm>
#include <cmath>

#include "field/facing.hpp"
#include "field/formulas.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// Signs (docs/method.md 2.7); all are judgement.
constexpr double kAgainst = 0.5;     // share of the agreement with a contact that turns a component
constexpr double kLeastVote = 1e-3;  // sum of weights times agreements: less is no vote

// Labels (docs/method.md 2.7); all are judgement.
constexpr float kMeetReach = 1.3f;      // R within which segments meet and components give signs
constexpr double kLeastMeeting = 1e-3;  // sum of weights: segments with less do not meet
constexpr float kSamePosition = 1e-3f;  // R; rounding sets the direction between closer points
constexpr double kSameNormal = 0.7;     // mean cosine of normals (46 degrees) of one segment
constexpr double kSamePlane = 0.3;      // mean sine (17 degrees) off the plane of one segment
constexpr float kBeyond = 0.2f;         // R, over which an edge is soft: farther out it has ended

// They bound the pairs that are compared (judgement).
constexpr std::uint32_t kTried = 16;       // points of a segment
constexpr std::uint32_t kReferences = 64;  // decided points

std::uint32_t stride_for(std::size_t count, std::uint32_t most) noexcept {
  return std::max<std::uint32_t>(1, (static_cast<std::uint32_t>(count) + most - 1) / most);
}

/// Is q beyond the plane of p, which is turned by `sign`? `offset`: from q to p.
bool is_beyond(const SegmentView::Point& p, const auto& q, const Vector3f& offset,
               float sign) noexcept {
  return -sign * p.normal.dot(offset) >
         kBeyond * p.radius + kUnsharp * std::max(p.residual, q.residual);
}

/// Swaps near and far faces where there is no concave neighbour, which leaves the field as it is.
/// False: something is.
bool swap_faces(auto& segments, auto& references) noexcept {
  const auto concave = [](const auto& x) { return x.label == kConcave; };
  if (std::ranges::any_of(segments, concave) || std::ranges::any_of(references, concave))
    return false;
  swap_labels(segments, kNearFace, kFarFace);
  swap_labels(references, kNearFace, kFarFace);
  return true;
}

}  // namespace

/// Calls visit(p, q, offset, w) for points p of the segment and decided ones q within kMeetReach of
/// it: the offset from q to p and how much it counts.
void Facing::each_meeting(const Segment& segment, const auto& visit) noexcept {
  const std::uint32_t step = stride_for(references_.size(), kReferences);
  const std::uint32_t skip = stride_for(segment.count, kTried);
  for (std::uint32_t k = 0; k < segment.count; k += skip) {
    const Point& p = view_.points[view_.order[segment.begin + k]];
    for (std::size_t r = 0; r < references_.size() && pairs_ > 0; r += step, --pairs_) {
      const Vector3f offset = p.position - references_[r].position;
      const double w = weight_within(offset.squaredNorm(), kMeetReach * p.radius);
      if (w > 0) visit(p, references_[r], offset, w);
    }
  }
}

/// Sums the votes of decided points around a component on its sign; below 0: turn it. What moved
/// keeps its normals; an arc joins points of one time.
double Facing::votes_on(std::uint32_t component) noexcept {
  double sum = 0;
  for (const Segment& segment : view_.table.segments) {
    if (segment.component != component) continue;
    each_meeting(
        segment, [&](const Point& p, const Reference& q, const Vector3f& offset, double w) {
          const float a =
              q.is_of_another_time(segment)
                  ? p.normal.dot(q.normal)
                  : agreement(p.normal, q.normal, offset, 3 * std::max(p.residual, q.residual));
          sum += static_cast<double>(p.confidence * q.confidence * a * std::abs(a)) * w;
        });
  }
  return sum;
}

/// Turns components whose points contradict a contact that begins: what it touches is in front.
void Facing::turn_by(const Vector3f& normal) noexcept {
  std::array<double, SegmentTable::kMost> agreed{};
  std::array<double, SegmentTable::kMost> all{};
  for (const Point& p : view_.points) {
    const float squared = p.position.squaredNorm();
    if (squared >= p.radius * p.radius) continue;
    const double w = static_cast<double>(p.confidence) * weight_within(squared, p.radius);
    const std::uint32_t component = view_.table.segments[p.segment].component;
    const float a = agreement(p.normal, normal, p.position, 3 * p.residual);
    agreed[component] +=
        w * static_cast<double>(a * std::abs(a)) * view_.table.components[component].sign;
    all[component] += w;
  }
  for (std::size_t k = 0; k < view_.table.components.size(); ++k) {
    Component& component = view_.table.components[k];
    if (component.is_one_sided() || !(-agreed[k] > std::max(kLeastVote, kAgainst * all[k])))
      continue;
    component.sign = -component.sign;
    for (Segment& segment : view_.table.segments) {
      if (segment.component == k) segment.label = SegmentTable::kUndecided;
    }
  }
}

/// `continued`: take a component's sign from its decided neighbours, not from visibility, which
/// decides where they do not. One-sided components always use visibility.
void Facing::decide_signs(bool continued) noexcept {
  std::vector<Component>& components = view_.table.components;
  int beside = 0;  // of components whose normals point outward, as they are seen
  for (const Component& component : components) {
    if (component.outward) beside += component.sign;
  }
  for (std::uint32_t k = 0; k < components.size(); ++k) {
    Component& component = components[k];
    if (component.sign != 0) continue;
    const bool inherits = continued && !component.is_one_sided();
    const double vote = !inherits ? 0 : component.outward && beside != 0 ? beside : votes_on(k);
    const double evidence = std::abs(vote) > kLeastVote ? vote : component.seen;
    if (evidence != 0) {
      component.sign = evidence < 0 ? -1 : 1;
      component.assumed = false;
    }
  }
}

/// Sums over the pairs that a segment's points make with decided ones of one label.
struct Facing::Meeting {
  double all = 0;       // of weights
  double parallel = 0;  // of the cosines between their normals
  double above = 0;     // of sines; below 0: at a convex edge
  double off = 0;       // of sines off the decided points' planes
  double now = 0;       // of weights, pairs with another time of the same source left out
  double off_now = 0;

  /// Is the segment what these points are of? It has to lie on their plane, but if it may be the
  /// same surface at another time (`moved`): there planes show only how far it went.
  [[nodiscard]] bool continues(bool moved) const noexcept {
    if (!(all > kLeastMeeting) || !(parallel > kSameNormal * all)) return false;
    return std::abs(moved ? off_now : off) <= kSamePlane * (moved ? now : all);
  }

  /// Is there an edge? Of two segments that face alike both lie below the other's plane at a convex
  /// edge, and above it at a concave one; of two that are stacked one lies above and one below.
  [[nodiscard]] bool is_edge() const noexcept {
    return all > kLeastMeeting && (parallel <= kSameNormal * all || off * (above - off) > 0);
  }
};

/// `beyond`: the weight of pairs where a near face goes on beyond the segment's plane.
Facing::Meetings Facing::meetings(const Segment& segment, double& beyond) noexcept {
  Meetings result{};
  const auto sign = static_cast<float>(view_.table.components[segment.component].factor());
  each_meeting(segment, [&](const Point& p, const Reference& q, const Vector3f& offset, double w) {
    const float length = offset.norm();
    if (!(length > kSamePosition * p.radius)) return;
    Meeting& m = result[q.label];
    const double off = w * static_cast<double>(q.normal.dot(offset) / length);
    m.all += w;
    m.parallel += w * static_cast<double>(sign * p.normal.dot(q.normal));
    m.above += w * static_cast<double>((q.normal - sign * p.normal).dot(offset) / length);
    m.off += off;
    if (!q.is_of_another_time(segment)) {
      m.now += w;
      m.off_now += off;
    }
    if (q.label == kNearFace && is_beyond(p, q, offset, sign)) beyond += w;
  });
  return result;
}

/// The label that follows from how the segment lies to segments whose labels are decided.
std::uint8_t Facing::label_of(const Segment& segment) noexcept {
  double beyond = 0;
  Meetings with = meetings(segment, beyond);
  for (const bool moved : {false, true}) {
    int same = -1;
    for (int k = 0; k < simd::kLabels; ++k) {
      if (with[k].continues(moved) && (same < 0 || with[k].all > with[same].all)) same = k;
    }
    if (same >= 0) return static_cast<std::uint8_t>(same);
  }
  for (Meeting& meeting : with) {
    if (!meeting.is_edge()) meeting = {};
  }
  if (with[0].all + with[1].all + with[2].all <= kLeastMeeting) return kNearFace;
  const int other = with[kNearFace].all > 0                   ? kNearFace
                    : with[kFarFace].all > with[kConcave].all ? kFarFace
                                                              : kConcave;
  const bool concave = with[other].above >= 0;
  // There is no edge where the near face goes on beyond the segment's plane: the segment would cut
  // it off there.
  const bool plate = with[other].parallel < -kBackToBack * with[other].all;
  if (other == kNearFace && !plate && beyond > kLeastMeeting) return kConcave;
  if (other == kFarFace && concave) {
    return swap_faces(view_.table.segments, references_) ? kConcave : kNearFace;
  }
  return concave ? kConcave : kFarFace;
}

/// Labels the segments that have no label, the weightiest first.
void Facing::decide_labels() noexcept {
  for (;;) {
    Segment* next = nullptr;
    for (Segment& segment : view_.table.segments) {
      if (segment.label == SegmentTable::kUndecided && (!next || segment.weight > next->weight))
        next = &segment;
    }
    if (!next) return;
    Component& component = view_.table.components[next->component];
    // Nothing of the component is seen: what is decided beside it gives its sign.
    if (component.sign == 0) {
      const double vote = component.is_one_sided() ? 0 : votes_on(next->component);
      component.sign = vote < 0 ? -1 : 1;
      component.assumed = vote == 0;
    }
    next->label = label_of(*next);
    add_references(*next);
  }
}

}  // namespace palpate
