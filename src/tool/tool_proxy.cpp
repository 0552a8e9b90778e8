// The proxy of a tool: what it takes, and the order of a step.
#include "palpate/tool/tool_proxy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/requirement.hpp"
#include "contact/limit.hpp"
#include "geometry/wrench.hpp"
#include "tool/tool_proxy_inside.hpp"

namespace palpate {
namespace {

constexpr Requirement kRequireProxy{"tool proxy"};  // the name that errors begin with
constexpr double kLeastTime = 1e-9;                 // s; friction divides by the time of a step
constexpr double kLeastGyration = 0.01;  // m: a tool as slim is turned with the fingers (judgement)
constexpr double kPointGyration = 1e-3;  // m, of a point, whose turns meet nothing
// m: the turns of a smaller or larger gyration are those of no hand, and are lost in rounding.
constexpr double kSmallestGyration = 1e-4;
// m: the surface may be another one.
constexpr double kAnywhere = std::numeric_limits<double>::infinity();

void check(const Friction& friction) {
  kRequireProxy.not_negative("friction.dynamic", friction.dynamic_coefficient, "give 0 or more");
  kRequireProxy.not_negative("friction.static", friction.static_coefficient, "give 0 or more");
  kRequireProxy.not_negative("friction.viscous", friction.viscous, "give 0 or more N s/m");
  kRequireProxy(friction.dynamic_coefficient <= friction.static_coefficient, "friction.dynamic",
                friction.dynamic_coefficient, "give at most the static coefficient, or raise that");
}

ToolOptions checked(const ToolOptions& options, const Tool& tool) {
  kRequireProxy.not_negative("stiffness", options.stiffness, "give N/m, 0 or more");
  check(options.friction);
  kRequireProxy.not_negative("texture.amplitude", options.texture.amplitude, "give m, 0 or more");
  kRequireProxy.positive("texture.wavelength", options.texture.wavelength, "give m, above 0");
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
         is_about_unit(pose.orientation) && std::abs(pose.opening) <= Proxy::kLargestCoordinate;
}

// The pose that a hand wants a tool to have: of unit length, and no farther closed than it can be.
Pose wanted_of(const Pose& given, const Tool& tool) {
  return {given.position, given.orientation.normalized(),
          tool.opens() ? std::max(0.0, given.opening) : 0.0};
}

// A field that serves all samples alike.
class Alone final : public ToolSurface {
 public:
  explicit Alone(const Field& field) : field_(field) {}
  [[nodiscard]] const Field& whole() const noexcept override { return field_; }

 private:
  const Field& field_;
};

}  // namespace

void ToolProxy::Inside::reset(const Pose& given) noexcept {
  state_ = in_range(given) ? State::put : State::fault;
  hand_ = last_hand_ = state_ == State::put ? wanted_of(given, *tool_) : Pose();
  descent_.put(hand_, false);
  descent_.shift(kAnywhere);
  spring_.reset();
  revision_.reset();
  factors_ = {};
}

ToolContact ToolProxy::Inside::faulted() const noexcept {
  ToolContact contact;
  contact.proxy = pose();
  contact.notes = ContactNote::fault;
  return contact;
}

ToolContact ToolProxy::Inside::step(const ToolSurface& surface, const Pose& given,
                                    double dt) noexcept {
  if (!in_range(given) || !std::isfinite(dt) || dt < 0 || !surface.serves(*tool_))
    state_ = State::fault;
  if (state_ == State::none) reset(given);
  if (state_ == State::fault) return faulted();
  const Pose hand = wanted_of(given, *tool_);
  const Pose before = pose();
  const Field::Traits traits = surface.whole().traits();
  see(surface, traits);
  ToolContact contact;
  surface.whole().begin_step();
  const double time = std::max(dt, kLeastTime);
  const bool outside =
      move(surface, hand,
           friction_law(options_.friction, factors_.friction, spring_.stiffness(), time), contact);
  free_hand(surface.whole(), hand, outside, dt, contact);
  report(surface, contact);
  end(surface);
  pull(before, hand, dt, changed_ ? &traits.step : nullptr, contact);
  if (state_ == State::put || !has(contact.notes, Limit::kUnfinished)) hand_ = hand;
  last_hand_ = hand;
  const bool faulty = has(contact.notes, ContactNote::fault);
  if (!faulty && is_finite(contact.wrench) && in_range(pose())) return contact;
  state_ = State::fault;
  descent_.put(hand, true);
  descent_.shift(kAnywhere);  // its odometer may not be finite
  return faulted();
}

// Keeps of what is known of the surface what still holds.
void ToolProxy::Inside::see(const ToolSurface& surface, const Field::Traits& traits) noexcept {
  const Field* const field = &surface.whole();
  changed_ = revision_ && *revision_ != traits.revision;
  if (field_ != field) {
    descent_.shift(kAnywhere);
  } else if (changed_) {
    descent_.shift(surface.moved());
  }
  field_ = field;
  revision_ = traits.revision;
}

ToolProxy::ToolProxy(std::shared_ptr<const Tool> tool, const ToolOptions& options) {
  if (!tool) throw Error("tool proxy: it has no tool; give one");
  const ToolOptions complete = checked(options, *tool);
  inside_ = std::make_unique<Inside>(std::move(tool), complete);
}
ToolProxy::~ToolProxy() = default;
ToolProxy::ToolProxy(ToolProxy&&) noexcept = default;
ToolProxy& ToolProxy::operator=(ToolProxy&&) noexcept = default;

ToolContact ToolProxy::step(const ToolSurface& surface, const Pose& hand, double dt) noexcept {
  return inside_->step(surface, hand, dt);
}

ToolContact ToolProxy::step(const Field& field, const Pose& hand, double dt) noexcept {
  return inside_->step(Alone(field), hand, dt);
}

void ToolProxy::change(double stiffness, const Friction& friction,
                       const Texture& texture) noexcept {
  inside_->change(stiffness, friction, texture);
}

bool ToolProxy::has_begun() const noexcept {
  return inside_->has_begun();
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
