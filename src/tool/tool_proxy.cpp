// A step of a tool's proxy: checks, motion, spring, and what is reported of it.
#include "palpate/tool/tool_proxy.hpp"

#include <algorithm>
#include <cmath>

#include "base/requirement.hpp"
#include "contact/limit.hpp"
#include "tool/descent.hpp"
#include "tool/tool_spring.hpp"

namespace palpate {
namespace {

constexpr Requirement kRequireProxy{"tool proxy"};  // the name that errors begin with
constexpr double kLeastGyration = 0.01;  // m: a tool as slim is turned with the fingers (judgement)
constexpr double kPointGyration = 1e-3;  // m, of a point, whose turns meet nothing
// m: the turns of a smaller or larger gyration are those of no hand, and are lost in rounding.
constexpr double kSmallestGyration = 1e-4;
constexpr double kNotUnit = 0.1;  // an orientation's length is so far from 1 by no rounding

std::shared_ptr<const Tool> checked(std::shared_ptr<const Tool> tool) {
  if (!tool) throw Error("tool proxy: it has no tool; give one");
  return tool;
}

ToolOptions checked(const ToolOptions& options, const Tool& tool) {
  kRequireProxy.not_negative("stiffness", options.stiffness, "give N/m, 0 or more");
  kRequireProxy(options.gyration == 0 ||
                    (options.gyration >= kSmallestGyration && options.gyration <= Tool::kLongest),
                "gyration", options.gyration, "give 0.0001 to 10 metres, or 0 for the tool's");
  kRequireProxy(options.iterations >= 2 && options.iterations <= 6, "iterations",
                options.iterations, "give 2 to 6");
  ToolOptions complete = options;
  if (options.gyration == 0) {
    complete.gyration = std::min(std::max(tool.gyration(), kLeastGyration),
                                 std::max(0.5 * tool.extent(), kPointGyration));
  }
  return complete;
}

bool in_range(const Pose& pose) {
  return pose.position.allFinite() &&
         pose.position.cwiseAbs().maxCoeff() <= Proxy::kLargestCoordinate &&
         std::abs(pose.orientation.norm() - 1) <= kNotUnit &&
         std::abs(pose.opening) <= Proxy::kLargestCoordinate;
}

// The pose that a hand wants a tool to have: of unit length, and no farther closed than it can be.
Pose wanted_of(const Pose& given, const Tool& tool) {
  return {given.position, given.orientation.normalized(),
          tool.opens() ? std::max(0.0, given.opening) : 0.0};
}

bool is_finite(const Wrench& wrench) {
  return wrench.force.allFinite() && wrench.torque.allFinite() && std::isfinite(wrench.grip);
}

// Clamps a share that a field gives: rounding or a wrong field may leave 0 to 1.
double share_of_one(double value) {
  return value >= 0 ? std::min(value, 1.0) : 0.0;
}

}  // namespace

/// What a tool's proxy does and what it keeps from step to step. Real-time.
class ToolProxy::Inside {
 public:
  Inside(std::shared_ptr<const Tool> tool, const ToolOptions& options)
      : tool_(checked(std::move(tool))),
        options_(checked(options, *tool_)),
        descent_(tool_, {options_.gyration}, options_.iterations) {}

  [[nodiscard]] ToolContact step(const Field& field, const Pose& given, double dt) noexcept;
  void reset(const Pose& given) noexcept;

  [[nodiscard]] const Pose& pose() const noexcept { return descent_.pose(); }
  [[nodiscard]] const Tool& tool() const noexcept { return *tool_; }
  [[nodiscard]] const ToolOptions& options() const noexcept { return options_; }

 private:
  [[nodiscard]] ToolContact faulted() const noexcept;
  [[nodiscard]] bool path_is_free(const Field& field, const Pose& hand) noexcept;
  void move(const Field& field, const Pose& hand, bool changed, ToolContact& contact) noexcept;
  void end(const Field& field) noexcept;
  void pull(const Pose& before, const Pose& hand, double dt, const double* step,
            ToolContact& contact) noexcept;
  void report(const Field& field, ToolContact& contact) noexcept;

  std::shared_ptr<const Tool> tool_;
  ToolOptions options_;
  Descent descent_;
  ToolSpring spring_;
  Pose hand_;                              // in the last step that caught up with it
  const Field* field_ = nullptr;           // in the last step; never looked into
  std::optional<std::uint64_t> revision_;  // of it, then; empty: no step since a reset
  double factor_ = 1;                      // of the stiffness, by what is touched
  bool started_ = false;
  bool fault_ = false;
};

void ToolProxy::Inside::reset(const Pose& given) noexcept {
  fault_ = !in_range(given);
  started_ = !fault_;
  hand_ = fault_ ? Pose() : wanted_of(given, *tool_);
  descent_.release(hand_);
  descent_.forget();  // whether it is free there, too
  spring_.reset();
  revision_.reset();
  factor_ = 1;
}

ToolContact ToolProxy::Inside::faulted() const noexcept {
  ToolContact contact;
  contact.proxy = pose();
  contact.notes = ContactNote::fault;
  return contact;
}

ToolContact ToolProxy::Inside::step(const Field& field, const Pose& given, double dt) noexcept {
  if (!in_range(given) || !std::isfinite(dt) || dt < 0) fault_ = true;
  if (fault_) return faulted();
  if (!started_) reset(given);
  const Pose hand = wanted_of(given, *tool_);
  const Pose before = pose();
  const Field::Traits traits = field.traits();
  const bool changed = revision_ && *revision_ != traits.revision;
  if (changed || field_ != &field) descent_.forget();
  field_ = &field;
  revision_ = traits.revision;
  ToolContact contact;
  field.begin_step();
  move(field, hand, changed, contact);
  report(field, contact);
  end(field);
  pull(before, hand, dt, changed ? &traits.step : nullptr, contact);
  if (!has(contact.notes, Limit::kUnfinished)) hand_ = hand;
  const bool faulty = has(contact.notes, ContactNote::fault);
  if (!faulty && is_finite(contact.wrench) && in_range(pose())) return contact;
  fault_ = true;
  descent_.release(hand);
  descent_.forget();  // an odometer that is not finite, too
  return faulted();
}

// One ball around the whole path of each tree: its center moves on a curve that bends away from
// the chord by an eighth of its greatest acceleration.
bool ToolProxy::Inside::path_is_free(const Field& field, const Pose& hand) noexcept {
  const double angle = turn_between(pose().orientation, hand.orientation).norm();
  const double opened = std::abs(hand.opening - pose().opening);
  for (const std::int32_t root : tool_->roots()) {
    const Tool::Node& node = tool_->nodes()[static_cast<std::size_t>(root)];
    const Eigen::Vector3d from = tool_->in_world(node.center, node.side, pose());
    const Eigen::Vector3d to = tool_->in_world(node.center, node.side, hand);
    const double lever = std::max((from - pose().position).norm(), (to - hand.position).norm());
    const double bow = angle * (angle * lever + opened) / 8;
    const Ball ball{0.5 * (from + to), node.radius + 0.5 * (to - from).norm() + bow};
    if (!descent_.gaps().is_free(field, ball)) return false;
  }
  return true;
}

void ToolProxy::Inside::move(const Field& field, const Pose& hand, bool changed,
                             ToolContact& contact) noexcept {
  descent_.gaps().begin(field, pose());
  if (path_is_free(field, hand)) return descent_.release(hand);
  if (changed) descent_.lift(field, field.traits().reanchor_reach, contact);
  const double moved = descent_.farthest(descent_.metric().between(hand_, hand));
  descent_.follow(field, hand, moved, contact);
}

// Ends the field's step where the tool presses most; if it does not, where it is nearest.
void ToolProxy::Inside::end(const Field& field) noexcept {
  const GapSearch::Nearest& nearest = descent_.gaps().nearest();
  Eigen::Vector3d x = nearest.normal.isZero(0) ? pose().position : nearest.position;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double most = -1;  // m, below any multiplier
  for (const Touches::Touch& touch : descent_.touches().span()) {
    if (touch.multiplier <= most) continue;
    most = touch.multiplier;
    const Tool::Point& sample = tool_->samples()[static_cast<std::size_t>(touch.sample)];
    x = tool_->in_world(sample.position, sample.side, pose());
    normal = touch.normal;
  }
  field.end_step(x, normal);
}

// `step`: how far a surface that has changed may have stepped, m; null: it has not changed.
void ToolProxy::Inside::pull(const Pose& before, const Pose& hand, double dt, const double* step,
                             ToolContact& contact) noexcept {
  const Metric& metric = descent_.metric();
  const bool held = spring_.touching();
  const bool at_hand = metric.between(hand, pose()).isZero(0);
  const double hand_moved = metric.between(hand_, hand).norm();
  const double open = Limit::kLeastFall * descent_.gaps().radius();
  const double jump = metric.between(before, pose()).norm() - 2 * hand_moved;
  const bool far = held && jump > open;
  const bool lifted = has(contact.notes, ContactNote::reanchored);
  if (far && !lifted && jump > Limit::kFall * metric.between(hand_, before).norm()) {
    contact.notes |= ContactNote::fell;
  }
  spring_.pull({.hand = hand,
                .before = before,
                .now = pose(),
                .full = factor_ * options_.stiffness,
                .moved = hand_moved + open,
                .dt = dt,
                // A tool that lags behind a hand which has let go is still held: else what it meets
                // next would begin as soft as the spring is stretched.
                .touching = descent_.touches().count > 0 || (held && !at_hand),
                .jumped = far && step != nullptr && jump > std::max(*step, Limit::kFastest * dt)},
               metric, contact);
  for (ToolContact::Touch& touch : contact.touches) touch.force *= spring_.stiffness();
}

// Reads what the surface is where it is touched, before the field's step ends: its budget counts
// that, too. A touch's force is still its multiplier.
void ToolProxy::Inside::report(const Field& field, ToolContact& contact) noexcept {
  contact.proxy = pose();
  contact.evaluations = descent_.gaps().evaluations() + descent_.touches().count;
  double sum = 0;
  double weighted = 0;
  double most = 0;
  for (const Touches::Touch& touch : descent_.touches().span()) {
    const Tool::Point& sample = tool_->samples()[static_cast<std::size_t>(touch.sample)];
    const Eigen::Vector3d x = tool_->in_world(sample.position, sample.side, pose());
    const Surface surface = field.surface(x);
    sum += touch.multiplier;
    weighted +=
        touch.multiplier * share_of_one(surface.stiffness_factor) * share_of_one(surface.presence);
    if (touch.multiplier > most) contact.source = surface.source;
    most = std::max(most, touch.multiplier);
    contact.touches[static_cast<std::size_t>(contact.touch_count++)] = {
        x, touch.normal, touch.multiplier, touch.sample};
  }
  if (sum > 0) factor_ = weighted / sum;
}

ToolProxy::ToolProxy(std::shared_ptr<const Tool> tool, const ToolOptions& options)
    : inside_(std::make_unique<Inside>(std::move(tool), options)) {}
ToolProxy::~ToolProxy() = default;
ToolProxy::ToolProxy(ToolProxy&&) noexcept = default;
ToolProxy& ToolProxy::operator=(ToolProxy&&) noexcept = default;

ToolContact ToolProxy::step(const Field& field, const Pose& hand, double dt) noexcept {
  return inside_->step(field, hand, dt);
}

const Pose& ToolProxy::pose() const noexcept {
  return inside_->pose();
}

const ToolOptions& ToolProxy::options() const noexcept {
  return inside_->options();
}

const Tool& ToolProxy::tool() const noexcept {
  return inside_->tool();
}

int ToolProxy::max_evaluations() const noexcept {
  return Descent::most_evaluations(tool());
}

void ToolProxy::reset(const Pose& pose) noexcept {
  inside_->reset(pose);
}

}  // namespace palpate
