#include "servo.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <utility>

#include "arrays.hpp"
#include "gil.hpp"
#include "module.hpp"
#include "options.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

/// Handle that Python holds. It stops the servo before the interpreter ends: no thread may outlive
/// that, and a device has to get zero force.
class ServoHandle {
 public:
  ServoHandle(const std::shared_ptr<SharedScene>& scene, const ServoPlan& plan) {
    {
      const Released release;
      running_ = std::make_shared<RunningServo>(scene, plan);
    }
    at_exit_ = py::cpp_function([weak = std::weak_ptr(running_)] {
      const Released release;
      if (const auto running = weak.lock()) running->stop();
    });
    py::module_::import("atexit").attr("register")(at_exit_);
  }
  ~ServoHandle() {
    try {
      stop();
    } catch (const py::error_already_set&) {
      // The interpreter is ending, and atexit has gone: it has stopped the servo.
    }
    const Released release;
    running_.reset();
  }
  ServoHandle(const ServoHandle&) = delete;
  ServoHandle& operator=(const ServoHandle&) = delete;

  void stop() {
    {
      const Released release;
      running_->stop();
    }
    if (!at_exit_) return;
    py::module_::import("atexit").attr("unregister")(std::exchange(at_exit_, py::object()));
  }

  [[nodiscard]] RunningServo& running() const { return *running_; }

 private:
  std::shared_ptr<RunningServo> running_;
  py::object at_exit_;
};

Trajectory trajectory_of(const py::object& hand, double dt) {
  if (hand.is_none()) return {};
  const Vectors positions(hand, "hand");
  Trajectory rows;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    rows.push_back({static_cast<double>(i) * dt, positions[i]});
  }
  return rows;
}

std::unique_ptr<ServoHandle> new_servo(const std::shared_ptr<SharedScene>& scene,
                                       const std::string& device, const py::object& hand, double dt,
                                       const Eigen::MatrixXd& pose, double scale,
                                       const py::kwargs& given) {
  if (!(scale > 0))
    throw Error(fmt::format("a servo's scale cannot be {}; give one above 0", scale));
  Keywords keywords(given, "Servo");
  ServoPlan plan{.device = device, .hand = trajectory_of(hand, dt)};
  plan.realtime.lock_memory = false;  // Python's memory is the whole process's
  plan.servo.workspace = {pose_of(pose), scale};
  take(keywords, plan.servo.field);
  take(keywords, plan.servo.proxy);
  take(keywords, plan.servo.guard);
  keywords.take("clutch_button", plan.servo.clutch_button);
  keywords.take("rate", plan.rate);
  keywords.take("realtime_priority", plan.realtime.realtime_priority);
  keywords.take("lock_memory", plan.realtime.lock_memory);
  keywords.take("processor", plan.realtime.processor);
  keywords.finish();
  return std::make_unique<ServoHandle>(scene, plan);
}

py::object ticks(const ServoHandle& handle) {
  std::vector<Tick> found;
  {
    const Released release;
    found = handle.running().ticks();
  }
  return record_array(found);
}

py::object state(const ServoHandle& handle) {
  return record(tick_of(handle.running().servo().state()));
}

void set_contact(const ServoHandle& handle, const py::kwargs& given) {
  Keywords keywords(given, "set_contact");
  ProxyOptions options = handle.running().servo().options().proxy;
  take(keywords, options);
  keywords.finish();
  handle.running().servo().set_contact({options.stiffness, options.friction, options.texture});
}

void set_field(const ServoHandle& handle, const py::kwargs& given) {
  Keywords keywords(given, "set_field");
  FieldOptions options = handle.running().servo().field();
  take(keywords, options);
  keywords.finish();
  handle.running().servo().set_field(options);
}

std::string words(const ServoHandle& handle) {
  const RunningServo& running = handle.running();
  const ServoState state = running.servo().state();
  return fmt::format("<palpate.Servo on {}: {} at {:.0f} Hz, {} steps, {:.3g} N>",
                     running.servo().device().info().name,
                     running.running() ? "running" : "stopped", running.rate(), state.step,
                     state.force.norm());
}

constexpr const char* kServo =
    R"(A hand in a scene, on a thread of its own; Python never runs in it.

device: simulated (a mass that a hand pulls along `hand`, (n, 3) m, a row each dt s, again and again, or to where
move() says), remote[:PATH], forcedimension, openhaptics, haply, ros:PRESET. pose: (4, 4) of the device's frame in the
world; scale: metres in the world for one at the hand. Keywords: those of Field and Proxy; of the guard
{}; clutch_button, rate (Hz),
realtime_priority, lock_memory, processor.)";

constexpr const char* kTicks = R"(Record array of the steps since the last call.

force: (n, 3) N, on the hand, through the guard; hip, proxy, normal: (n, 3), world; time: s; ... Up to 16384 steps
wait; `dropped` counts those that found no room.)";

void add_force(const ServoHandle& handle, const Eigen::Vector3d& force) {
  handle.running().servo().add_force(force);
}

void move(const ServoHandle& handle, const Eigen::Vector3d& position) {
  handle.running().move(position);
}

bool running(const ServoHandle& handle) {
  const Released release;
  return handle.running().running();
}

void define_facts(py::class_<ServoHandle>& servo) {
  using Handle = ServoHandle;
  servo.def_property_readonly("running", &running)
      .def_property_readonly(
          "problem", [](const Handle& self) { return self.running().problem(); },
          "why there is no force; empty: nothing is wrong")
      .def_property_readonly("dropped", [](const Handle& self) { return self.running().dropped(); })
      .def_property_readonly(
          "rate", [](const Handle& self) { return self.running().rate(); }, "Hz")
      .def_property_readonly(
          "stiffness_limit",
          [](const Handle& self) { return self.running().servo().stiffness_limit(); },
          "the stiffest surface that this device can hold, N/m")
      .def_property_readonly(
          "realtime", [](const Handle& self) { return in_words(self.running().realtime()); },
          "what the system granted, in words");
}

}  // namespace

void define_servo(py::module_& module) {
  using py::arg;
  using Handle = ServoHandle;
  register_tick();
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  py::class_<Handle> servo(module, "Servo",
                           fmt::format(kServo, listed(keywords_of<GuardOptions>())).c_str());
  servo
      .def(py::init(&new_servo), arg("scene"), arg("device") = "simulated", py::kw_only(),
           arg("hand") = py::none(), arg("dt") = 1e-3, arg("pose") = identity, arg("scale") = 1.0)
      .def("__repr__", [](const Handle& handle) { return words(handle); })
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Handle& self, const py::args&) { self.stop(); })
      .def("stop", &Handle::stop, "Ends the thread: zero force")
      .def("state", &state, "The newest step, a record as in ticks()")
      .def("ticks", &ticks, kTicks)
      .def("add_force", &add_force, arg("force"),
           "A force from outside, (3,) N, world: goes through the guard and fades in 0.1 s")
      .def("move", &move, arg("position"), "Moves the simulated hand to (3,), m, world")
      .def("set_contact", &set_contact, "Changes stiffness, friction_* and texture_*")
      .def("set_field", &set_field, "Changes the keywords of Field")
      .def(
          "pause", [](Handle& self, bool on) { self.running().servo().pause(on); },
          arg("paused") = true, "Fades the force to zero, and back")
      .def(
          "reset", [](Handle& self) { self.running().servo().reset(); },
          "Clears faults and contact");
  define_facts(servo);
}

}  // namespace palpate::python
