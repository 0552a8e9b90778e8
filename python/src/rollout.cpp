// Runs all ticks of a hand without the GIL.
#include "rollout.hpp"

#include <fmt/format.h>

#include <cmath>

#include "arrays.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

// Output memory of a rollout: plain pointers, since numpy may be asked for them only with the GIL.
struct Rows {
  explicit Rows(Rollout& out)
      : time(out.time.mutable_data()),
        hip(out.hip.mutable_data()),
        force(out.force.mutable_data()),
        proxy(out.proxy.mutable_data()),
        normal(out.normal.mutable_data()),
        stiffness(out.stiffness.mutable_data()),
        touching(out.touching.mutable_data()),
        sliding(out.sliding.mutable_data()),
        source(out.source.mutable_data()),
        iterations(out.iterations.mutable_data()),
        evaluations(out.evaluations.mutable_data()),
        notes(out.notes.mutable_data()),
        field_notes(out.field_notes.mutable_data()) {}

  void put(std::size_t i, double now, const Eigen::Vector3d& hand,
           const Contact& contact) noexcept {
    time[i] = now;
    Eigen::Map<Eigen::Vector3d>(hip + 3 * i) = hand;
    Eigen::Map<Eigen::Vector3d>(force + 3 * i) = contact.force;
    Eigen::Map<Eigen::Vector3d>(proxy + 3 * i) = contact.proxy;
    Eigen::Map<Eigen::Vector3d>(normal + 3 * i) = contact.normal;
    stiffness[i] = contact.stiffness;
    touching[i] = contact.touching;
    sliding[i] = contact.sliding;
    source[i] = contact.source;
    iterations[i] = contact.iterations;
    evaluations[i] = contact.evaluations;
    notes[i] = static_cast<std::uint32_t>(contact.notes);
  }

  double *time, *hip, *force, *proxy, *normal, *stiffness;
  bool *touching, *sliding;
  std::int32_t *source, *iterations, *evaluations;
  std::uint32_t *notes, *field_notes;
};

// The times of the ticks: given, or `dt` apart from where the proxy has come to.
class Times {
 public:
  Times(const std::optional<py::object>& given, std::size_t ticks, double dt) : dt_(dt) {
    if (!(dt > 0)) throw Error(fmt::format("dt is {} s; give the time between ticks, above 0", dt));
    if (!given) return;
    array_ = readable(*given, "time", {kFloat64}, {static_cast<py::ssize_t>(ticks)});
    times_ = static_cast<const double*>(array_.data());
  }

  void begin(double start) noexcept { start_ = start; }
  [[nodiscard]] double at(std::size_t i) const noexcept {
    return times_ != nullptr ? times_[i] : start_ + static_cast<double>(i) * dt_;
  }
  /// Since the tick before; before the first it is dt.
  [[nodiscard]] double step(std::size_t i) const noexcept {
    return times_ != nullptr && i > 0 ? times_[i] - times_[i - 1] : dt_;
  }

 private:
  py::array array_;
  const double* times_ = nullptr;
  double start_ = 0;
  double dt_;
};

}  // namespace

void TimedProxy::reset(const Eigen::Vector3d& position) {
  const std::lock_guard lock(mutex);
  proxy.reset(position);
}

Eigen::Vector3d TimedProxy::position() {
  const std::lock_guard lock(mutex);
  return proxy.position();
}

double TimedProxy::next_time() {
  const std::lock_guard lock(mutex);
  return time;
}

Contact TimedProxy::step(AnyField& field, const Eigen::Vector3d& hip, double now,
                         double dt) noexcept {
  if (SceneField* const scene = field.of_scene()) scene->update(now, hip, proxy);
  if (std::isfinite(now + dt) && dt >= 0) time = now + dt;  // else a fault, and time stands still
  field.stepped(now);
  return proxy.step(field.field(), hip, dt);
}

Rollout::Rollout(py::ssize_t ticks)
    : time(ticks),
      hip({ticks, py::ssize_t{3}}),
      force({ticks, py::ssize_t{3}}),
      proxy({ticks, py::ssize_t{3}}),
      normal({ticks, py::ssize_t{3}}),
      stiffness(ticks),
      touching(ticks),
      sliding(ticks),
      source(ticks),
      iterations(ticks),
      evaluations(ticks),
      notes(ticks),
      field_notes(ticks) {}

std::unique_ptr<Rollout> rollout(AnyField& field, TimedProxy& proxy, const py::object& hand,
                                 double dt, const std::optional<py::object>& time) {
  const Vectors hips(hand, "hand");
  Times times(time, hips.size(), dt);
  auto result = std::make_unique<Rollout>(static_cast<py::ssize_t>(hips.size()));
  Rows rows(*result);
  const Away away(field.mutex, proxy.mutex);
  times.begin(proxy.time);
  for (std::size_t i = 0; i < hips.size(); ++i) {
    if (i % kUninterrupted == kUninterrupted - 1) hear_signals();
    const double now = times.at(i);
    const Contact contact = proxy.step(field, hips[i], now, times.step(i));
    rows.put(i, now, hips[i], contact);
    SceneField* const scene = field.of_scene();
    rows.field_notes[i] = scene != nullptr ? static_cast<std::uint32_t>(scene->notes()) : 0;
  }
  return result;
}

}  // namespace palpate::python
