#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "fields.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::python {

namespace py = pybind11;

/// A proxy with the time that it has come to. One thread uses it at a time: who holds the mutex.
struct TimedProxy {
  explicit TimedProxy(const ProxyOptions& options) : proxy(options) {}

  void reset(const Eigen::Vector3d& position);
  [[nodiscard]] Eigen::Vector3d position();
  [[nodiscard]] double next_time();

  /// A tick: the field is brought to `now`, then the proxy follows the hand.
  Contact step(AnyField& field, const Eigen::Vector3d& hip, double now, double dt) noexcept;

  Proxy proxy;
  double time = 0;  ///< of the next tick, s
  std::mutex mutex = {};
};

/// Results of a hand's ticks, a row each.
struct Rollout {
  explicit Rollout(py::ssize_t ticks);

  py::array_t<double> time, hip, force, proxy, normal, stiffness;
  py::array_t<bool> touching, sliding;
  py::array_t<std::int32_t> source, iterations, evaluations;
  py::array_t<std::uint32_t> notes, field_notes;
};

/// All ticks of a hand, without the GIL.
/// @throws py::type_error as Vectors does.
[[nodiscard]] std::unique_ptr<Rollout> rollout(AnyField& field, TimedProxy& proxy,
                                               const py::object& hand, double dt,
                                               const std::optional<py::object>& time);

}  // namespace palpate::python
