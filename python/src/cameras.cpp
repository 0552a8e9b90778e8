// Binds depth cameras and their frames.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "gil.hpp"
#include "module.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::python {
namespace {

// s that one read may wait, so that Ctrl-C is noticed (judgement)
constexpr double kPatience = 0.1;

/// A driver of a camera. One thread reads at a time.
struct OpenCamera {
  std::unique_ptr<DepthCamera> camera;
  std::mutex mutex = {};
};

using Frame = std::shared_ptr<DepthFrame>;

std::unique_ptr<OpenCamera> open_one(const std::string& name, bool loop) {
  auto opened = std::make_unique<OpenCamera>();
  opened->camera = open_camera(name, {.loop = loop});
  return opened;
}

DepthCamera::Status read(OpenCamera& from, DepthFrame& frame, double timeout) {
  const Away away(from.mutex);
  return from.camera->read(frame, timeout);
}

// The next frame of use; null: the recording has ended, or none came in time.
Frame next_frame(OpenCamera& from, double timeout) {
  using enum DepthCamera::Status;
  auto found = std::make_shared<DepthFrame>();
  const SteadyClock clock;
  const double end = clock.now() + timeout;
  while (true) {
    const DepthCamera::Status status = read(from, *found, std::min(timeout, kPatience));
    if (status == frame) return found;
    if (status == ended) return nullptr;
    if (status == failed) throw Error(from.camera->reason());
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (clock.now() > end) return nullptr;
  }
}

Frame read_next(OpenCamera& from) {
  constexpr double kLongest = 10;  // s
  Frame found = next_frame(from, kLongest);
  while (!found && from.camera->info().awaits_sender) found = next_frame(from, kLongest);
  if (!found) throw py::stop_iteration();
  return found;
}

py::array depth_of(const Frame& frame, const py::handle& owner) {
  return view_of(frame->depth.data(), {frame->camera.height, frame->camera.width}, owner);
}

std::array<double, 4> intrinsics(const Frame& frame) {
  const Pinhole& p = frame->camera.pinhole;
  return {p.fx, p.fy, p.cx, p.cy};
}

std::array<double, 5> distortion(const Frame& frame) {
  const CameraModel::Distortion& d = frame->camera.distortion;
  return {d.k1, d.k2, d.p1, d.p2, d.k3};
}

std::pair<int, int> size(const Frame& frame) {
  return {frame->camera.width, frame->camera.height};
}

std::string name(const OpenCamera& from) {
  return from.camera->info().name;
}

double rate(const OpenCamera& from) {
  return from.camera->info().rate;
}

py::object pose(const Frame& frame) {
  if (!frame->T_world_sensor) return py::none();
  return py::cast(frame->T_world_sensor->matrix().eval());
}

py::list drivers(const std::vector<DriverInfo>& found) {
  using py::literals::operator""_a;
  py::list result;
  for (const DriverInfo& driver : found) {
    py::list devices;
    for (const DriverInfo::Device& device : driver.devices) devices.append(device.name);
    result.append(py::dict("name"_a = driver.name, "description"_a = driver.description,
                           "available"_a = driver.available, "missing"_a = driver.missing,
                           "devices"_a = devices));
  }
  return result;
}

// Looks for them without the GIL.
py::list look_for(std::vector<DriverInfo> (*list)()) {
  std::vector<DriverInfo> found;
  {
    const Released release;
    found = list();
  }
  return drivers(found);
}

std::string words(const DepthFrame& frame) {
  return fmt::format("<palpate.Frame: {} x {} at {:.6g} s>", frame.camera.width,
                     frame.camera.height, frame.stamp);
}

void define_frame(py::module_& module) {
  py::class_<DepthFrame, Frame>(module, "Frame", "One image of a depth camera")
      .def("__repr__", [](const DepthFrame& frame) { return words(frame); })
      .def_property_readonly(
          "depth", [](const py::object& self) { return depth_of(self.cast<Frame>(), self); },
          "(height, width) float32, m, read-only; 0: nothing measured")
      .def_property_readonly("K", &intrinsics, "(fx, fy, cx, cy), pixels")
      .def_property_readonly("size", &size, "(width, height), pixels")
      .def_property_readonly("distortion", &distortion, "(k1, k2, p1, p2, k3)")
      .def_property_readonly("pose", &pose, "(4, 4), camera to world, at the stamp, or None")
      .def_readonly("stamp", &DepthFrame::stamp, "s");
}

}  // namespace

void define_cameras(py::module_& module) {
  using py::arg;
  using Bound = OpenCamera;
  define_frame(module);
  py::class_<Bound>(module, "DepthCamera", "Frames of a driver or a recording: iterate or read()")
      .def("__repr__", [](const Bound& from) { return "<palpate.DepthCamera " + name(from) + ">"; })
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &read_next)
      .def("read", &next_frame, arg("timeout") = 1.0,
           "The next frame; None: none came in `timeout` s, or the recording has ended")
      .def_property_readonly("name", &name)
      .def_property_readonly("rate", &rate, "frames a second");
  module.def(
      "open_camera", &open_one, arg("name"), py::kw_only(), arg("loop") = false,
      py::call_guard<Released>(),
      "simulated[:SCENE], sequence:FOLDER, bag:FILE, openni2, freenect, FILE.oni, ros:TOPIC, "
      "remote[:PATH]");
  module.def(
      "list_cameras", [] { return look_for(&list_cameras); }, "Every driver of cameras");
  module.def(
      "list_devices", [] { return look_for(&list_devices); }, "Every driver of haptic devices");
}

}  // namespace palpate::python
