// Turns servo states into rows of numpy record arrays.
#include "ticks.hpp"

#include <algorithm>
#include <span>

namespace palpate::python {
namespace {

namespace py = pybind11;

void put(double (&to)[3], const Eigen::Vector3d& from) noexcept {
  std::copy(from.begin(), from.end(), to);
}

}  // namespace

void register_tick() {
  PYBIND11_NUMPY_DTYPE(Tick, step, time, dt, hip, velocity, orientation, gripper, force,
                       contact_force, proxy, normal, stiffness, lateness, computing, source, notes,
                       field_notes, guard_notes, buttons, touching, sliding, paused, clutched,
                       device);
}

Tick tick_of(const ServoState& state) noexcept {
  const Contact& contact = state.contact;
  Tick tick{};
  tick.step = state.step;
  tick.time = state.time;
  tick.dt = state.dt;
  put(tick.hip, state.hip);
  put(tick.velocity, state.velocity);
  std::ranges::copy(state.orientation.coeffs(), tick.orientation);
  tick.gripper = state.gripper;
  put(tick.force, state.force);
  put(tick.contact_force, contact.force);
  put(tick.proxy, contact.proxy);
  put(tick.normal, contact.normal);
  tick.stiffness = contact.stiffness;
  tick.lateness = state.timing.lateness;
  tick.computing = state.timing.computing;
  tick.source = contact.source;
  tick.notes = static_cast<std::uint32_t>(contact.notes);
  tick.field_notes = static_cast<std::uint32_t>(state.field_notes);
  tick.guard_notes = static_cast<std::uint32_t>(state.guard.notes);
  tick.buttons = state.buttons;
  tick.touching = contact.touching;
  tick.sliding = contact.sliding;
  tick.paused = state.paused;
  tick.clutched = state.clutched;
  tick.device = static_cast<std::uint8_t>(state.device);
  return tick;
}

py::object record_array(const std::vector<Tick>& ticks) {
  const py::array_t<Tick> rows(static_cast<py::ssize_t>(ticks.size()), ticks.data());
  return rows.attr("view")(py::module_::import("numpy").attr("recarray"));
}

py::object record(const Tick& tick) {
  const py::object kind = py::module_::import("numpy").attr("record");
  const py::dtype named = py::dtype::from_args(py::make_tuple(kind, py::dtype::of<Tick>()));
  return py::array(named, std::vector<py::ssize_t>{1}, &tick)[py::int_(0)];
}

}  // namespace palpate::python
