// Goes down the trees of balls to the samples near the surface, past what is known to be far.
#include "tool/gap_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/probe.hpp"

namespace palpate {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();  // known of a gap
// A share of a gap, that a sample can move unseen: gaps are of first order, and where a surface
// curves it is nearer than that (judgement).
constexpr double kTrusted = 0.6;
constexpr double kUnseen = 0.5;  // of R: the distance where no point has weight (judgement)
// In R: how much larger a ball is asked to be than it has to, and how far the tool moves before one
// that was not free is asked again. Smaller: more questions; larger: more of them in vain.
constexpr double kExtra = 0.5;
constexpr double kPush = 0.25;       // of R, that a surface which came pushes the tool in one look
constexpr double kSameFace = 0.5;    // cosine: within 60 degrees, as of a point (method.md 3.4)
constexpr double kResolutions = 16;  // R where no surface says it: what resolution is a share of
constexpr double kRiseSteps = 8;     // in R, on a path on which a touch is found again (judgement)
constexpr double kLeastSteps = 4;    // of these (judgement)
constexpr double kMostSteps = 64;    // of these: no surface as thick as R / 4 is missed in 16 R
constexpr int kBisections = 12;      // of one of these: to 3e-5 R
constexpr double kLongestWay = 1e3;  // m, after which bounds would lose 0.1 pm to rounding
constexpr double kLeastMargin = 0.02;  // of R, that an overfull list leaves

// The gap between x and the surface with its relief, which is carved into `here`; empty where there
// is no surface to speak of.
std::optional<double> gap_over(const Texture& texture, const Eigen::Vector3d& x, Sample& here) {
  carve(texture, x, here);
  return first_order_distance(here);
}

}  // namespace

GapSearch::GapSearch(std::shared_ptr<const Tool> tool)
    : tool_(std::move(tool)),
      sample_bounds_(tool_->samples().size(), kNothing),
      node_bounds_(tool_->nodes().size(), kNothing),
      node_asked_(tool_->nodes().size(), kNothing) {}

void GapSearch::forget() noexcept {
  std::fill(sample_bounds_.begin(), sample_bounds_.end(), kNothing);
  std::fill(node_bounds_.begin(), node_bounds_.end(), kNothing);
  std::fill(node_asked_.begin(), node_asked_.end(), kNothing);
  odometer_ = 0;
}

void GapSearch::begin(const ToolSurface& surface, const Texture& texture,
                      const Pose& pose) noexcept {
  evaluations_ = 0;
  texture_ = texture;
  pushed_out_ = surface.pushed_out();
  nearest_.fill({});
  if (odometer_ > kLongestWay) forget();
  if (radius_known_) return;
  ++evaluations_;
  const double radius = surface.whole().sample(pose.position).radius;
  radius_known_ = radius > 0;
  radius_ = radius_known_ ? radius : kResolutions * surface.whole().traits().resolution;
}

bool GapSearch::is_free(const Field& field, const Ball& ball) noexcept {
  ++evaluations_;
  return field.is_free(ball);
}

bool GapSearch::is_free_at(const Field& field, const Pose& pose) noexcept {
  return std::ranges::all_of(tool_->roots(),
                             [&](std::int32_t root) { return is_free_below(field, pose, root); });
}

bool GapSearch::is_free_below(const Field& field, const Pose& pose, std::int32_t index) noexcept {
  const Tool::Node& node = tool_->nodes()[static_cast<std::size_t>(index)];
  const Eigen::Vector3d center = tool_->in_world(node.center, node.side, pose);
  if (is_free(field, {center, node.radius - pushed_out_})) return true;
  return node.left >= 0 && is_free_below(field, pose, node.left) &&
         is_free_below(field, pose, node.right);
}

double GapSearch::gap(const Field& field, const Tool::Point& sample,
                      const Eigen::Vector3d& x) noexcept {
  ++evaluations_;
  Sample here = field.sample(x);
  const bool free = here.value > 0 || is_nothing(here.value, here.support);
  here.value -= sample.radius - pushed_out_;
  return gap_over(texture_, x, here).value_or(free ? 1 : -1);
}

bool GapSearch::sees_still(const Field& field, const Tool::Point& sample, const Eigen::Vector3d& x,
                           const Eigen::Vector3d& normal) noexcept {
  ++evaluations_;
  Sample here = field.sample(x);
  here.value -= sample.radius - pushed_out_;
  const std::optional<double> gap = gap_over(texture_, x, here);
  return gap && *gap > -kPush * radius_ && here.gradient.normalized().dot(normal) > kSameFace;
}

double GapSearch::rise(const Field& field, const Tool::Point& sample, const Eigen::Vector3d& x,
                       const Eigen::Vector3d& path) noexcept {
  const auto is_free = [&](double share) { return gap(field, sample, x + share * path) > 0; };
  if (!is_free(1)) return 0;
  const int steps = static_cast<int>(
      std::clamp(std::ceil(kRiseSteps * path.norm() / radius_), kLeastSteps, kMostSteps));
  int last = steps;  // that is free all the way from the end
  while (last > 0 && is_free(static_cast<double>(last - 1) / steps)) --last;
  if (last == 0) return 0;
  double free = static_cast<double>(last) / steps;
  double solid = static_cast<double>(last - 1) / steps;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (free + solid);
    (is_free(middle) ? free : solid) = middle;
  }
  return free;
}

Look GapSearch::look(const ToolSurface& surface, const Pose& pose, const Metric& metric,
                     double margin, ConstraintList& constraints) noexcept {
  Walk walk{surface, pose, metric, constraints, {.margin = margin}};
  nearest_.fill({});
  surface.place(pose);
  walk.found.clearance = std::numeric_limits<double>::infinity();
  for (const std::int32_t root : tool_->roots()) {
    visit(walk, root);
    const double bound = node_bounds_[static_cast<std::size_t>(root)];
    walk.found.clearance = std::min(walk.found.clearance, bound - odometer_);
  }
  return walk.found;
}

// The field of the group that holds all samples of the node, or of them all.
const Field& GapSearch::field_of(const ToolSurface& surface,
                                 const Tool::Node& node) const noexcept {
  const int group = surface.group_of(static_cast<int>(node.begin));
  const bool all = group == surface.group_of(static_cast<int>(node.end) - 1);
  return all ? surface.group(group) : surface.whole();
}

void GapSearch::visit(Walk& walk, std::int32_t index) noexcept {
  if (passes(walk, index)) return;
  const auto at = static_cast<std::size_t>(index);
  const Tool::Node& node = tool_->nodes()[at];
  if (node.left >= 0) {
    visit(walk, node.left);
    visit(walk, node.right);
    node_bounds_[at] = std::min(node_bounds_[static_cast<std::size_t>(node.left)],
                                node_bounds_[static_cast<std::size_t>(node.right)]);
    return;
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    if (sample_bounds_[i] - odometer_ < walk.found.margin) look_at(walk, i);
    least = std::min(least, sample_bounds_[i]);
  }
  node_bounds_[at] = least;
}

// Is nothing within the margin of the node's samples, as far as is known or one ball shows?
bool GapSearch::passes(Walk& walk, std::int32_t index) noexcept {
  const auto at = static_cast<std::size_t>(index);
  if (node_bounds_[at] - odometer_ >= walk.found.margin) return true;
  if (node_asked_[at] >= odometer_) return false;
  const Tool::Node& node = tool_->nodes()[at];
  const double free = walk.found.margin + kExtra * radius_;
  const Eigen::Vector3d center = tool_->in_world(node.center, node.side, walk.pose);
  const Ball ball{center, node.radius - pushed_out_ + free};
  const bool is = is_free(field_of(walk.surface, node), ball);
  if (is) {
    node_bounds_[at] = odometer_ + free;
  } else {
    node_asked_[at] = odometer_ + kExtra * radius_;
  }
  return is;
}

void GapSearch::look_at(Walk& walk, std::uint32_t index) noexcept {
  ++evaluations_;
  const Tool::Point& sample = tool_->samples()[index];
  const Eigen::Vector3d x = tool_->in_world(sample.position, sample.side, walk.pose);
  const int group = walk.surface.group_of(static_cast<int>(index));
  Sample here = walk.surface.group(group).sample(x);
  if (here.radius > 0) {
    radius_ = here.radius;
    radius_known_ = true;
  }
  const double unseen = std::max(0.0, kUnseen * radius_ - sample.radius);
  sample_bounds_[index] = odometer_ + kTrusted * unseen;
  const bool free = here.value > 0 || is_nothing(here.value, here.support);
  here.value -= sample.radius - pushed_out_;
  const std::optional<double> gap = first_order_distance(here);
  const Eigen::Vector3d normal = here.gradient.normalized();
  const bool finite = std::isfinite(gap.value_or(0)) && normal.allFinite();
  if (!gap || !finite) {  // a field that is not finite is wrong, and solid
    if (finite && free) return;
    walk.found.unknown = true;
    sample_bounds_[index] = kNothing;
    return;
  }
  if (here.averted) return;
  // Where weights begin the field is flat, and says no distance: 14 mm were trusted of 3. A relief
  // is carved, and no nearer than that.
  const double trusted = here.support < 1 ? std::min(*gap, unseen) : *gap;
  sample_bounds_[index] = odometer_ + kTrusted * trusted;
  Nearest found{*gap, x, normal};
  if (texture_.amplitude > 0) {
    // Where a relief is so steep that the surface has no slope, the smooth one serves.
    if (const std::optional<double> carved = gap_over(texture_, x, here)) {
      found = {*carved, x, here.gradient.normalized()};
    }
  }
  meet(walk, index, group, found);
}

// A sample of a group that may be within the margin.
void GapSearch::meet(Walk& walk, std::uint32_t index, int group, const Nearest& found) noexcept {
  walk.found.deepest = std::min(walk.found.deepest, found.gap);
  Nearest& nearest = nearest_[static_cast<std::size_t>(group)];
  if (nearest.normal.isZero(0) || found.gap < nearest.gap) nearest = found;
  if (found.gap >= walk.found.margin) return;
  constrain(walk,
            constraint_on(*tool_, static_cast<int>(index), found.position, found.normal, walk.pose,
                          walk.metric),
            found.gap);
}

// Where the list is full the nearer half stays, and the margin ends before what was dropped.
void GapSearch::constrain(Walk& walk, Constraint constraint, double gap) const noexcept {
  if (walk.constraints.full()) {
    walk.found.margin =
        std::clamp(-walk.constraints.drop_half(), kLeastMargin * radius_, walk.found.margin);
    if (gap >= walk.found.margin) return;
  }
  constraint.bound = std::min(-gap, kPush * radius_);
  walk.constraints.add(constraint);
}

}  // namespace palpate
