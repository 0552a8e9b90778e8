// Divides a tool's samples into groups and follows the scene for all of them.
#include "palpate/tool/tool_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/requirement.hpp"
#include "tool/tool_field_inside.hpp"

namespace palpate {
namespace {

constexpr Requirement kRequire{"tool field"};  // the name that errors begin with
// R: samples farther apart do not share a patch. Measured where a box of 456 samples rests on a
// stream, p50 and p99 of a step: 204 and 466 us, with 1 R 208 and 535, with 0.7 R 227 and 785.
constexpr double kGroup = 1.5;
constexpr double kWider = 1.25;  // times, until there are no more than kMostGroups (judgement)
// Times that R may be another than that of the groups: then a patch has half as many points, or
// twice (judgement).
constexpr double kOtherRadius = 1.5;
constexpr double kFelt = 2;  // R around a tool; normals beside rims need neighbours (judgement)
// m: the surface may be another one.
constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

std::shared_ptr<const Tool> held(std::shared_ptr<const Tool> tool) {
  if (!tool) throw Error("tool field: it has no tool; give one");
  return tool;
}

const FieldOptions& checked(const FieldOptions& options) {
  ToolField::check(options);
  return options;
}

// The surface as a point meets it whose ball is the least that a sample of the tool has.
FieldOptions with_balls(const FieldOptions& options, const Tool& tool) noexcept {
  FieldOptions pushed = options;
  if (options.raw_weights) return pushed;  // a level of these says no length
  const auto least = std::ranges::min_element(tool.samples(), {}, &Tool::Point::radius);
  pushed.tool_radius = least->radius;
  return pushed;
}

// Groups, at most, whose balls are no larger than `radius` (m) or of one leaf.
int groups_within(const Tool& tool, double radius) noexcept {
  int count = 0;
  for (const Tool::Node& node : tool.nodes()) {
    const bool small = node.radius <= radius || node.left < 0;
    if (node.left >= 0 && !small) ++count;  // each division adds one
  }
  return count + static_cast<int>(tool.roots().size());
}

bool is_finite(const Pose& pose) {
  return pose.position.allFinite() && pose.orientation.coeffs().allFinite() &&
         std::isfinite(pose.opening);
}

}  // namespace

ToolField::Inside::Inside(Scene& scene, std::shared_ptr<const Tool> tool,
                          const FieldOptions& options, const std::string& name, double scale)
    : tool_(held(std::move(tool))),
      scene_(scene, *tool_, with_balls(checked(options), *tool_), name, scale),
      group_of_(tool_->samples().size(), 0) {
  const std::size_t most = std::min<std::size_t>(kMostGroups, tool_->nodes().size());
  groups_.reserve(most);
  while (groups_.size() < most) groups_.emplace_back(scene_);
  divide(0);
}

void ToolField::Inside::update(double now, const Pose& hand, const Pose& proxy) noexcept {
  FollowedSources& followed = scene_.followed;
  scene_.begin_update();
  const double before = std::exchange(now_, std::isfinite(now) ? now : now_);
  const double passed = std::max(0.0, now_ - before);
  const bool changed = followed.advance(now, scene_.surface.options);
  const bool same = followed.same();
  const double widened = scene_.widened();
  for (AgreedSides& finger : fingers_) {
    // Addresses of layers that are gone may come back as those of others.
    if (changed && !same) finger.forget();
    finger.begin_update(passed);
  }
  for (SampleGroup& each : used()) each.update(passed, changed, same);
  const bool wider = std::exchange(widened_, widened) != widened;  // then all of it moves at once
  if (changed) change(same && !wider ? kFastestCloud * passed : kAnyDistance);
  divide_anew();
  const bool finite = is_finite(hand) && is_finite(proxy);
  const double opening = std::max(std::abs(hand.opening), std::abs(proxy.opening));
  const double reach = tool_->extent() + 0.5 * opening + kFelt * std::max(radius_, scene_.radius());
  if (finite) {
    scene_.place(proxy);
    followed.report(hand.position, proxy.position, reach);
  }
  notes_ = scene_.is_empty() ? FieldNote::no_surface : FieldNote::none;
  const bool raw = scene_.surface.options.raw_weights;
  if (followed.layers().other_kernel && !raw) notes_ = notes_ | FieldNote::other_kernel;
  if (finite && followed.misses({proxy.position, reach})) notes_ = notes_ | FieldNote::not_loaded;
  if (!std::isfinite(now)) notes_ = notes_ | FieldNote::time_not_finite;
}

void ToolField::Inside::take(const FieldOptions& checked) noexcept {
  const FieldOptions taken = with_balls(checked, *tool_);
  if (taken == scene_.surface.options) return;  // nothing to gather again
  scene_.surface.change(taken);
  scene_.followed.list(taken);
  for (SampleGroup& each : used()) each.release();
  change(kAnyDistance);
}

void ToolField::Inside::forget_sides() noexcept {
  for (AgreedSides& finger : fingers_) finger.forget();
  for (SampleGroup& each : used()) each.forget_sides();
}

void ToolField::Inside::change(double moved) noexcept {
  ++revision_;
  moved_ += moved;
}

/// Groups are as large as patches are meant for where the tool is, not for the mean of a scene.
/// What touches keeps its group, and its side.
void ToolField::Inside::divide_anew() noexcept {
  if (scene_.is_empty()) return;
  double sum = 0;
  int looking = 0;
  for (const SampleGroup& each : used()) {
    if (each.touches()) return;
    if (each.looks()) sum += each.radius();
    looking += each.looks() ? 1 : 0;
  }
  if (looking == 0 && radius_ > 0) return;  // what is elsewhere says nothing of what is here
  const double radius = looking > 0 ? sum / looking : scene_.radius();
  if (radius < kOtherRadius * radius_ && radius_ < kOtherRadius * radius) return;
  divide(radius);
  change(kAnyDistance);
}

void ToolField::Inside::divide(double radius) noexcept {
  radius_ = radius;
  for (SampleGroup& each : used()) each.release();
  double largest = kGroup * radius;
  while (groups_within(*tool_, largest) > kMostGroups) largest = std::max(kWider * largest, 1e-6);
  count_ = 0;
  for (const std::int32_t root : tool_->roots()) {
    assign(root, largest);
  }
}

void ToolField::Inside::assign(std::int32_t root, double radius) noexcept {
  const Tool::Node& node = tool_->nodes()[static_cast<std::size_t>(root)];
  if (node.left >= 0 && node.radius > radius) {
    assign(node.left, radius);
    assign(node.right, radius);
    return;
  }
  const auto samples = std::span(group_of_).subspan(node.begin, node.end - node.begin);
  std::ranges::fill(samples, static_cast<std::uint8_t>(count_));
  const auto finger = static_cast<std::size_t>(node.side + 1);
  groups_[static_cast<std::size_t>(count_++)].assign(node, fingers_[finger]);
}

Sample ToolField::Inside::sample(const Eigen::Vector3d& x) const noexcept {
  if (scene_.is_empty() || !x.allFinite()) return {.value = 1};  // free, how far is unknown
  return scene_.sample(scene_.patch_away(x, nullptr), x);
}

bool ToolField::Inside::is_free(const Ball& ball) const noexcept {
  if (scene_.is_empty()) return true;
  return ball.center.allFinite() && std::isfinite(ball.radius) && scene_.walk_is_free(ball);
}

Surface ToolField::Inside::surface(const Eigen::Vector3d& x) const noexcept {
  if (scene_.is_empty() || !x.allFinite()) return {};
  return scene_.made_of(scene_.patch_away(x, nullptr), x);
}

Field::Traits ToolField::Inside::traits() const noexcept {
  return {.resolution = radius_ / 16,
          .revision = revision_,
          .reanchor_reach = kFastestCloud * scene_.followed.layers().cloud_duration,
          .step = scene_.followed.step()};
}

void ToolField::Inside::begin_step() const noexcept {
  scene_.begin_step();
  moved_ = 0;
}

FieldNote ToolField::Inside::notes() const noexcept {
  FieldNote notes = notes_ | scene_.work().notes;
  for (const SampleGroup& each : std::span(groups_).first(static_cast<std::size_t>(count_))) {
    if (!each.looks()) continue;
    if (each.patch().sides().is_behind()) notes = notes | FieldNote::behind;
    if (each.patch().thinned() && each.patch().extra() >= 0) notes = notes | FieldNote::thinned;
  }
  return notes;
}

ToolField::ToolField(Scene& scene, std::shared_ptr<const Tool> tool, const FieldOptions& options,
                     const std::string& name, double scale)
    : inside_(std::make_unique<Inside>(scene, std::move(tool), options, name, scale)) {}
ToolField::~ToolField() = default;

void ToolField::update(double now, const Pose& hand, const ToolProxy& proxy) noexcept {
  inside_->update(now, hand, proxy.has_begun() ? proxy.pose() : hand);
}
void ToolField::change(const FieldOptions& checked) noexcept {
  inside_->take(checked);
}

void ToolField::check(const FieldOptions& options) {
  palpate::check(options);
  kRequire(options.tool_radius == 0, "tool_radius", options.tool_radius,
           "give 0: a tool's samples have radii of their own");
  kRequire(!options.nearest_radius, "nearest_radius", 1, "give false: a tool is in many places");
}

const Field& ToolField::whole() const noexcept {
  return *inside_;
}
int ToolField::group_of(int sample) const noexcept {
  return inside_->group_of(sample);
}
const Field& ToolField::group(int number) const noexcept {
  return inside_->group(number);
}
double ToolField::pushed_out() const noexcept {
  return inside_->scene().surface.options.tool_radius;
}
void ToolField::place(const Pose& tool) const noexcept {
  inside_->scene().place(tool);
}
void ToolField::forget_sides() const noexcept {
  inside_->forget_sides();
}
bool ToolField::is_across(double deeper) const noexcept {
  return !inside_->scene().is_empty() &&
         std::ranges::any_of(inside_->used(),
                             [=](const SampleGroup& each) { return each.is_behind(deeper); });
}
double ToolField::moved() const noexcept {
  return inside_->moved();
}
bool ToolField::serves(const Tool& tool) const noexcept {
  return tool.samples().size() == inside_->samples();
}
SceneField::Found ToolField::found() const noexcept {
  return inside_->scene().followed.found();
}
FieldNote ToolField::notes() const noexcept {
  return inside_->notes();
}
int ToolField::groups() const noexcept {
  return static_cast<int>(inside_->used().size());
}
std::uint64_t ToolField::gathers() const noexcept {
  return inside_->scene().work().gathers;
}
std::uint64_t ToolField::visits() const noexcept {
  return inside_->scene().work().visits;
}

}  // namespace palpate
