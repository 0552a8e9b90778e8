#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <vector>

#include "palpate/servo/servo.hpp"

namespace palpate::python {

/// A step of a servo as a row of a structured array. World frame, SI units.
struct Tick {
  std::uint64_t step;
  double time, dt;
  double hip[3], velocity[3], orientation[4];  // x, y, z, w
  double gripper;
  double force[3], contact_force[3], proxy[3], normal[3];
  double stiffness, lateness, computing;
  std::int32_t source;
  std::uint32_t notes, field_notes, guard_notes, buttons;
  bool touching, sliding, paused, clutched;
  std::uint8_t device;
};

/// Tells numpy of Tick; once, as the module is made.
void register_tick();

[[nodiscard]] Tick tick_of(const ServoState& state) noexcept;

/// A record array: rows.force and rows["force"].
[[nodiscard]] pybind11::object record_array(const std::vector<Tick>& ticks);

/// A row of it. Runs no code of Python's: a daemon thread that asks for it as the interpreter ends
/// is ended inside of such code, and would take what C++ holds with it.
[[nodiscard]] pybind11::object record(const Tick& tick);

}  // namespace palpate::python
