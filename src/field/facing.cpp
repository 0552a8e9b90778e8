// Keeps what is decided of the sheets near the tool from one call to the next.

#include "field/facing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palpate/field/field_options.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// A part keeps its sign while one of its points is within kHolds, a sheet its label within kMeets.
// Both are above 1 R, where weights end. Labels are settled later, when more is known.
constexpr float kHolds = 1.5f;  // R; judgement
constexpr float kMeets = 1.1f;  // R; judgement

constexpr int kPairs = 2048;  // compared in one call, to bound its time; judgement

}  // namespace

Facing::Facing(std::size_t capacity) {
  now_.clear();
  before_.clear();
  points_.reserve(capacity);
  sheet_of_place_.reserve(capacity);
  order_.reserve(capacity);
  references_.reserve(2 * capacity);
  remembered_.reserve(2 * capacity);
}

void Facing::forget() noexcept {
  now_.clear();
  remembered_.clear();
}

void Facing::reopen() noexcept {
  now_.clear_sheets();
  for (Part& part : std::span(now_.parts).first(now_.part_count)) part.sign = 0;
  remembered_.clear();
}

void Facing::follow(const Facing& other) noexcept {
  follows_ = true;
  touched_ = other.touched_;
  was_behind_ = other.was_behind_;
  if (other.now_.part_count == 0) return;
  now_.copy(other.now_);
  remembered_ = other.remembered_;  // within what was reserved
  remembered_from_ = other.remembered_from_;
}

std::uint32_t Facing::part_of(Part part) noexcept {
  for (std::uint32_t k = now_.part_count; k-- > 0;) {
    if (now_.parts[k].key == part.key) return k;
  }
  for (const Part& before : std::span(before_.parts).first(before_.part_count)) {
    if (before.key != part.key) continue;
    part.sign = before.sign;
    if (before.weighs) part.seen = before.seen;
  }
  now_.parts[now_.part_count] = part;
  return now_.part_count++;
}

void Facing::Table::clear_sheets() noexcept {
  sheet_count = 0;
  slots.fill(kMost);
}

void Facing::Table::clear() noexcept {
  part_count = 0;
  clear_sheets();
}

void Facing::Table::copy(const Table& other) noexcept {
  std::copy_n(other.parts.begin(), other.part_count, parts.begin());
  std::copy_n(other.sheets.begin(), other.sheet_count, sheets.begin());
  part_count = other.part_count;
  sheet_count = other.sheet_count;
  slots = other.slots;
}

std::uint8_t* Facing::Table::find(const Key& key) noexcept {
  auto at = static_cast<std::uint8_t>((key.number * 2654435761u) >> 24);
  while (slots[at] < kMost && sheets[slots[at]].key != key) ++at;
  return &slots[at];
}

/// The slot of a sheet, which is made if it is new; kMost: there are too many. Parts are never more
/// than sheets, so there is room for them.
std::uint32_t Facing::sheet_of(const ActiveLayer& layer, std::uint32_t number) noexcept {
  const SurfacePoints& points = *layer.points;
  const SurfacePoints::Sheets& own = points.sheets;
  const Key key = own.empty() ? key_of_all(points) : Key{&points, number};
  std::uint8_t* const slot = now_.find(key);
  if (*slot < kMost || now_.sheet_count == kMost) return *slot;
  Part part{.key = key_of_all(points), .known = own.empty() || own.known[own.part[number]] != 0};
  part.unsure = points.one_sided && !part.known;
  if (!own.empty() && (part.unsure || !points.one_sided)) part.key = {&points, own.part[number]};
  Sheet sheet{.key = key, .source = layer.source, .part = part_of(part)};
  const std::uint8_t before = *before_.find(key);
  if (before < kMost) sheet.label = before_.sheets[before].label;
  now_.sheets[now_.sheet_count] = sheet;
  return *slot = static_cast<std::uint8_t>(now_.sheet_count++);
}

void Facing::list_layer(const ActiveLayer& layer, std::span<const std::uint32_t> places,
                        const Stance& stance) noexcept {
  const SurfacePoints& surface = *layer.points;
  const SurfacePoints::Sheets& own = surface.sheets;
  std::uint32_t last = SurfacePoints::Sheets::kNone;
  std::uint32_t slot = kMost;
  for (const std::uint32_t i : places) {
    const double confidence = surface.normals.empty() ? 0 : confidence_now(layer, i);
    const std::uint32_t sheet = own.empty() ? 0 : own.sheet[i];
    if (confidence <= 0 || sheet == SurfacePoints::Sheets::kNone) {
      sheet_of_place_.push_back(surface.one_sided ? kUnsure : kMost);
      continue;
    }
    if (sheet != last) slot = sheet_of(layer, last = sheet);
    sheet_of_place_.push_back(slot == kMost && surface.one_sided ? kUnsure : slot);
    if (slot == kMost) continue;
    Point point{};
    point.place = position_now(layer, i, stance.proxy).cast<float>();
    point.normal = normal_now(layer, i).cast<float>();
    point.confidence = static_cast<float>(confidence);
    point.radius = static_cast<float>(radius_now(layer, i));
    point.sheet = slot;
    point.residual = own.empty() ? 0 : own.residual[i];
    point.above = own.empty() ? std::numeric_limits<float>::infinity() : own.above[i];
    point.below = own.empty() ? std::numeric_limits<float>::infinity() : own.below[i];
    points_.push_back(point);
    Sheet& s = now_.sheets[slot];
    const float distance = point.place.norm();
    Part& part = now_.parts[s.part];
    // A part that all points share keeps its side until free space.
    part.near |= own.empty() || part.key == kOneSided || distance <= kHolds * point.radius;
    part.weighs |= distance <= point.radius;
    if (own.empty() || distance <= kMeets * point.radius) s.near = true;
    ++s.count;
  }
}

void Facing::list(const Points& points, const Stance& stance) noexcept {
  before_.copy(now_);
  now_.clear();
  points_.clear();
  sheet_of_place_.clear();
  for (std::size_t k = 0; k < points.layers.size(); ++k) {
    const Selection::Run& run = points.selection->runs()[k];
    list_layer(points.layers[k], points.selection->places(run), stance);
  }
  float radii = 0;
  for (const Point& point : points_) radii += point.radius;
  if (!points_.empty()) radius_ = radii / static_cast<float>(points_.size());
}

/// Forgets the sign of a part without weight at the proxy, or that a free proxy is behind, and the
/// label of a sheet that has moved away.
void Facing::let_go(const Stance& stance) noexcept {
  for (Part& part : std::span(now_.parts).first(now_.part_count)) {
    if (!part.near || (part.is_absent() && !stance.touches())) part.sign = 0;
  }
  for (Sheet& sheet : std::span(now_.sheets).first(now_.sheet_count)) {
    if (!sheet.near) sheet.label = kOpen;
  }
}

void Facing::group() noexcept {
  std::uint32_t begin = 0;
  for (Sheet& sheet : std::span(now_.sheets).first(now_.sheet_count)) {
    sheet.begin = begin;
    begin += sheet.count;
    sheet.count = 0;
  }
  order_.resize(points_.size());
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    Sheet& sheet = now_.sheets[points_[i].sheet];
    order_[sheet.begin + sheet.count++] = i;
  }
}

void Facing::add_references(const Sheet& sheet) noexcept {
  const Part& part = now_.parts[sheet.part];
  const int sign = part.factor();
  if (sheet.label == kOpen || sign == 0) return;
  for (std::uint32_t k = 0; k < sheet.count; ++k) {
    const Point& p = points_[order_[sheet.begin + k]];
    if (references_.size() == references_.capacity()) return;
    if (part.is_absent() && !is_above(p)) continue;
    references_.push_back({sheet.key.owner, sheet.source, p.place,
                           static_cast<float>(sign) * p.normal, p.confidence, p.residual,
                           sheet.label});
  }
}

/// Lists all points that are decided. Where a cloud gave way to another, the points remembered of
/// it are among them, for what lies in their place now. Returns whether they are.
bool Facing::list_references(const Stance& stance) noexcept {
  references_.clear();
  bool vanished = false;
  for (const Sheet& old : std::span(before_.sheets).first(before_.sheet_count)) {
    vanished = vanished || (old.near && *now_.find(old.key) == kMost);
  }
  if (vanished) {
    const Vector3f shift = (remembered_from_ - stance.proxy).cast<float>();
    for (Reference r : remembered_) {
      r.place += shift;
      r.cloud = nullptr;
      references_.push_back(r);
    }
  }
  for (const Sheet& sheet : std::span(now_.sheets).first(now_.sheet_count)) add_references(sheet);
  return vanished;
}

bool Facing::write(const Points& points) const noexcept {
  bool changed = false;
  std::size_t next = 0;  // of points_
  for (std::size_t k = 0; k < sheet_of_place_.size(); ++k) {
    const std::uint32_t slot = sheet_of_place_[k];
    std::int8_t sign = 1;
    bool unsure = slot == kUnsure;  // of one view, with no side of its own
    std::uint8_t label = kInFront;
    if (slot < kMost) {
      const Part& part = now_.parts[now_.sheets[slot].part];
      sign = static_cast<std::int8_t>(part.sign);
      unsure = part.unsure;
      label = now_.sheets[slot].label;
      if (part.is_absent()) sign = is_above(points_[next]) ? 1 : 0;
      ++next;
    }
    if (unsure && was_behind_) sign = 0;
    changed = changed || points.signs[k] != sign || points.labels[k] != label;
    points.signs[k] = sign;
    points.labels[k] = label;
  }
  return changed;
}

/// Are all points of one part whose side is decided, so that nothing needs a look?
bool Facing::is_settled(std::span<const ActiveLayer> layers) const noexcept {
  if (now_.sheet_count != 1 || now_.sheets[0].label != kInFront || sees_from_behind()) {
    return false;
  }
  return std::ranges::all_of(layers, [this](const ActiveLayer& layer) {
    return layer.points->sheets.empty() && now_.sheets[0].key == key_of_all(*layer.points);
  });
}

void Facing::look(const Points& points, const Stance& stance) noexcept {
  pairs_ = kPairs;
  rise_ = points.rise;
  list(points, stance);
  if (points_.empty()) return;
  if (!std::exchange(follows_, false)) let_go(stance);
  group();
  const auto decided = [this](const Sheet& sheet) { return is_decided(sheet); };
  if (!std::ranges::all_of(std::span(now_.sheets).first(now_.sheet_count), decided)) {
    choose_eye(stance);
    see(stance);
  }
  const bool begins = stance.touches() && !touched_;
  touched_ = stance.touches();
  if (begins) turn_by(stance.normal.cast<float>());
  const auto older = static_cast<std::ptrdiff_t>(remembered_.size());
  const bool vanished = list_references(stance);
  decide_signs(stance.touches() || vanished);
  decide_labels();
  if (vanished) references_.erase(references_.begin(), references_.begin() + older);
  std::swap(references_, remembered_);
  remembered_from_ = stance.proxy;
}

/// Does what is near say whether the proxy is behind? Points of views that do not tell their side
/// do not: they are absent for a proxy that is.
bool Facing::tells() const noexcept {
  const std::span<const Part> parts = std::span(now_.parts).first(now_.part_count);
  const bool side = std::ranges::any_of(parts, [](const Part& p) { return p.key == kOneSided; });
  return side || (std::ranges::none_of(parts, &Part::unsure) &&
                  std::ranges::count(sheet_of_place_, kUnsure) == 0);
}

bool Facing::face(const Points& points, const Stance& stance) noexcept {
  if (is_settled(points.layers)) {
    sheet_of_place_.assign(points.signs.size(), 0);
  } else {
    look(points, stance);
  }
  if (tells()) was_behind_ = sees_from_behind();
  return write(points);
}

}  // namespace palpate
