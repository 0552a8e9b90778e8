// Decides the signs of parts that come into view, and the labels of their sheets.

#include <algorithm>
#include <cmath>
#include <span>

#include "field/facing.hpp"
#include "field/formulas.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// Signs (docs/method.md 2.7); all are judgement.
constexpr float kUnsharp = 2;         // residuals that a height has to exceed to tell a side
constexpr float kAcrossReach = 0.9f;  // R within which decided points tell signs
constexpr double kLeastVote = 1e-3;   // sum of weights times agreements: less is no vote

// Labels (docs/method.md 2.7); all are judgement.
constexpr float kMeetReach = 1.3f;      // R within which sheets meet
constexpr double kLeastMeeting = 1e-3;  // sum of weights: sheets with less do not meet
constexpr float kSamePlace = 1e-3f;     // R; rounding sets the direction between closer points
constexpr double kSameNormal = 0.7;     // mean cosine of normals (46 degrees) of one sheet
constexpr double kSamePlane = 0.3;      // mean sine (17 degrees) off the plane of one sheet
constexpr float kBeyond = 0.2f;         // R, over which an edge is soft: farther out it has ended
constexpr float kHiddenView = 2.6f;     // R from the eye: points within tell if a sheet is hidden

// They bound the pairs that are compared (judgement).
constexpr std::uint32_t kTried = 16;       // points of a sheet
constexpr std::uint32_t kReferences = 64;  // decided points

double weight(float squared, float reach) noexcept {
  return wyvill(static_cast<double>(squared / (reach * reach))).w;
}

std::uint32_t stride_for(std::size_t count, std::uint32_t most) noexcept {
  return std::max<std::uint32_t>(1, (static_cast<std::uint32_t>(count) + most - 1) / most);
}

}  // namespace

/// Calls visit(p, q, way, w) for points p of the sheet and decided ones q that are near it: the way
/// from q to p and how much it counts, which ends at `reach` of p's R.
template <class Visit>
void Facing::each_meeting(const Sheet& sheet, float reach, const Visit& visit) noexcept {
  const std::uint32_t step = stride_for(references_.size(), kReferences);
  const std::uint32_t skip = stride_for(sheet.count, kTried);
  for (std::uint32_t k = 0; k < sheet.count; k += skip) {
    const Point& p = points_[order_[sheet.begin + k]];
    for (std::size_t r = 0; r < references_.size() && pairs_ > 0; r += step, --pairs_) {
      const Vector3f way = p.place - references_[r].place;
      const double w = weight(way.squaredNorm(), reach * p.radius);
      if (w > 0) visit(p, references_[r], way, w);
    }
  }
}

/// Sums the votes of decided points around a part on its sign; below 0: turn it.
double Facing::across(std::uint32_t part) noexcept {
  double sum = 0;
  for (const Sheet& sheet : std::span(now_.sheets).first(now_.sheet_count)) {
    if (sheet.part != part) continue;
    each_meeting(sheet, kAcrossReach,
                 [&sum](const Point& p, const Reference& q, const Vector3f& way, double w) {
                   const float a =
                       agreement(p.normal, q.normal, way, 3 * std::max(p.residual, q.residual));
                   sum += static_cast<double>(p.confidence * q.confidence * a * std::abs(a)) * w;
                 });
  }
  return sum;
}

/// The key of the one sheet and part that points without sheets of their own belong to.
Facing::Key Facing::key_of_all(const SurfacePoints& points) noexcept {
  return points.one_sided ? kOneSided : Key{};
}

/// Is the part seen from behind, the side that no sensor saw?
bool Facing::is_absent(const Part& part) noexcept {
  return part.key == kOneSided && part.sign < 0;
}

bool Facing::sees_from_behind() const noexcept {
  return std::ranges::any_of(std::span(now_.parts).first(now_.part_count), is_absent);
}

bool Facing::is_hidden(const Point& point, float height) const noexcept {
  return std::abs(height) > (height > 0 ? point.above : point.below) + point.residual;
}

bool Facing::is_one_sided(const Point& point) const noexcept {
  return now_.parts[now_.sheets[point.sheet].part].key == kOneSided;
}

/// The height of the surface above a point, m.
float Facing::rise_of(const Point& point) const noexcept {
  return static_cast<float>(rise_.length + rise_.share * static_cast<double>(point.radius));
}

/// Is the eye in front of the point's surface?
bool Facing::is_above(const Point& point) const noexcept {
  return height_over(point) >= rise_of(point);
}

/// The factor for a part's normals, 1 or -1; 0: not decided. One-sided parts are never turned.
int Facing::sign_of(const Part& part) noexcept {
  return is_absent(part) ? 1 : part.sign;
}

/// How high the eye is above the surface at a point, m. What was seen from one side alone is never
/// turned, and close above a bulge the planes of most of its points are higher than the eye: half
/// of what the closest point says keeps these down.
float Facing::height_over(const Point& point) const noexcept {
  const Vector3f way = eye_ - point.place;
  const float height = point.normal.dot(way);
  const bool bent = is_one_sided(point) && point.normal.dot(beside_) > 0.5f;
  return bent ? 0.5f * (height + beside_.dot(way)) : height;
}

/// `continued`: take a part's sign from its decided neighbours, not from visibility, which decides
/// where they do not. One-sided parts always use visibility.
void Facing::decide_signs(bool continued) noexcept {
  for (const Point& p : points_) {
    Sheet& sheet = now_.sheets[p.sheet];
    const Vector3f way = eye_ - p.place;
    const float squared = way.squaredNorm();
    const float height = height_over(p);
    const bool hidden = is_hidden(p, height);
    if (const double w = weight(squared, kHiddenView * radius_); w > 0) {
      sheet.all += w;
      if (hidden) sheet.hidden += w;
    }
    if (squared >= view_ * view_) continue;
    const double w = static_cast<double>(p.confidence) * weight(squared, view_);
    sheet.weight += w;
    const float length = std::max(std::sqrt(squared), 1e-12f);
    // A proxy that comes from behind is in front only above the surface, not above its points.
    const float over = was_behind_ && is_one_sided(p) ? height - rise_of(p) : height;
    const double sharp = std::max(0.f, std::abs(over) - kUnsharp * p.residual) / length;
    if (!hidden) now_.parts[sheet.part].seen += w * sharp * (over < 0 ? -1 : 1);
  }
  int beside = 0;  // of parts whose normals point outward, as they are seen
  for (const Part& part : std::span(now_.parts).first(now_.part_count)) {
    if (part.known) beside += part.sign;
  }
  for (std::uint32_t k = 0; k < now_.part_count; ++k) {
    Part& part = now_.parts[k];
    if (part.sign != 0) continue;
    const bool told = continued && part.key != kOneSided;
    const double vote = !told ? 0 : part.known && beside != 0 ? beside : across(k);
    part.sign = (std::abs(vote) > kLeastVote ? vote : part.seen) < 0 ? -1 : 1;
  }
}

/// The label that follows from how the sheet lies to sheets whose labels are known.
std::uint8_t Facing::label_of(const Sheet& sheet) noexcept {
  double parallel[simd::kLabels] = {};
  double above[simd::kLabels] = {};
  double all[simd::kLabels] = {};
  const auto sign = static_cast<float>(sign_of(now_.parts[sheet.part]));
  double planes[simd::kLabels] = {};
  double beyond = 0;  // of what is in front: where it goes on beyond the sheet's plane
  each_meeting(
      sheet, kMeetReach, [&](const Point& p, const Reference& q, const Vector3f& way, double w) {
        const float length = way.norm();
        if (!(length > kSamePlace * p.radius)) return;
        parallel[q.label] += w * static_cast<double>(sign * p.normal.dot(q.normal));
        planes[q.label] += w * static_cast<double>(q.normal.dot(way) / length);
        above[q.label] += w * static_cast<double>((q.normal - sign * p.normal).dot(way) / length);
        all[q.label] += w;
        const float unsharp = kUnsharp * std::max(p.residual, q.residual);
        const bool passes = -sign * p.normal.dot(way) > kBeyond * p.radius + unsharp;
        if (q.label == kInFront && passes) beyond += w;
      });
  int same = -1;
  for (int k = 0; k < simd::kLabels; ++k) {
    const bool one = all[k] > kLeastMeeting && parallel[k] > kSameNormal * all[k] &&
                     std::abs(planes[k]) < kSamePlane * all[k];
    if (one && (same < 0 || all[k] > all[same])) same = k;
  }
  if (same >= 0) return static_cast<std::uint8_t>(same);
  if (all[0] + all[1] + all[2] <= kLeastMeeting) {
    return sheet.hidden <= 0.5 * sheet.all ? kInFront : kBehind;
  }
  const int other = all[kInFront] > kLeastMeeting ? kInFront
                    : all[kBehind] > all[kAcross] ? kBehind
                                                  : kAcross;
  const bool concave = above[other] >= 0;
  // No edge is where the front goes on beyond the sheet's plane: the sheet would cut it off there.
  const bool plate = parallel[other] < -kBackToBack * all[other];
  if (other == kInFront && !plate && beyond > kLeastMeeting) return kAcross;
  if (other == kBehind && concave) return kInFront;
  if (other == kAcross && !concave) return kInFront;
  return concave ? kAcross : kBehind;
}

/// The weightiest sheet first.
void Facing::decide_labels() noexcept {
  for (;;) {
    Sheet* next = nullptr;
    for (Sheet& sheet : std::span(now_.sheets).first(now_.sheet_count)) {
      if (sheet.label == kOpen && (!next || sheet.weight > next->weight)) next = &sheet;
    }
    if (!next) return;
    next->label = label_of(*next);
    add_references(*next);
  }
}

}  // namespace palpate
