// Binds tools that turn and their proxy.
#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "fields.hpp"
#include "module.hpp"
#include "palpate/tool/tool_field.hpp"
#include "palpate/tool/tool_proxy.hpp"

namespace palpate::python {
namespace {

/// A proxy of a tool with the field that it touches, and its clock.
class HeldTool {
 public:
  HeldTool(std::shared_ptr<const Tool> tool, std::shared_ptr<SharedScene> scene,
           const ToolOptions& options)
      : scene_(std::move(scene)),
        surface_(std::in_place, scene_->scene, tool),
        proxy_(std::move(tool), options) {}
  HeldTool(std::shared_ptr<const Tool> tool, std::shared_ptr<AnyField> formula,
           const ToolOptions& options)
      : formula_(std::move(formula)), proxy_(std::move(tool), options) {}

  // An update sees the time that begins, as that of a point.
  ToolContact step(const Pose& hand, double dt) {
    const Away away(formula_ ? formula_->mutex : free_, mutex_);
    if (surface_) surface_->update(time_, hand, proxy_);
    if (scene_) scene_->time.store(time_);
    if (std::isfinite(dt) && dt >= 0) time_ += dt;
    return surface_ ? proxy_.step(*surface_, hand, dt) : proxy_.step(formula_->field(), hand, dt);
  }
  void reset(const Pose& pose) {
    const Away away(mutex_);
    proxy_.reset(pose);
  }
  [[nodiscard]] const ToolOptions& options() const noexcept { return proxy_.options(); }
  [[nodiscard]] double time() {
    const Away away(mutex_);
    return time_;
  }

 private:
  std::shared_ptr<SharedScene> scene_;
  std::optional<ToolField> surface_;  // of the scene
  std::shared_ptr<AnyField> formula_;
  ToolProxy proxy_;
  double time_ = 0;  // s, of the next step
  std::mutex mutex_;
  std::mutex free_;  // in the place of a formula's
};

Pose hand_pose(const Eigen::MatrixXd& matrix, double opening) {
  const Eigen::Isometry3d pose = pose_of(matrix);
  return {pose.translation(), Eigen::Quaterniond(pose.linear()), opening};
}

Eigen::Matrix4d matrix_of(const Pose& pose) {
  return (Eigen::Translation3d(pose.position) * pose.orientation).matrix();
}

std::vector<Eigen::Vector3d> points_of(const py::object& given) {
  const Vectors vectors(given, "vertices");
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < vectors.size(); ++i) points.push_back(vectors[i]);
  return points;
}

// Triangles of (m, 3) whole numbers.
std::vector<Tool::Triangle> triangles_of(const py::array_t<std::int64_t>& given) {
  if (given.ndim() != 2 || given.shape(1) != 3) {
    throw py::type_error("triangles: give (m, 3) indices of vertices");
  }
  const auto rows = given.unchecked<2>();
  std::vector<Tool::Triangle> triangles;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    Tool::Triangle corners{};
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t index = rows(i, k);
      // One that is no index is beyond all vertices.
      corners[static_cast<std::size_t>(k)] =
          index < 0 || index > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(index);
    }
    triangles.push_back(corners);
  }
  return triangles;
}

// What is touched, as (n, 3) columns or (n,).
template <class Value>
py::array_t<double> of_touches(const ToolContact& contact, std::vector<py::ssize_t> shape,
                               const Value& value) {
  shape.insert(shape.begin(), contact.touch_count);
  py::array_t<double> result(shape);
  double* out = result.mutable_data();
  for (int k = 0; k < contact.touch_count; ++k) {
    for (const double number : value(contact.touches[static_cast<std::size_t>(k)])) {
      *out++ = number;
    }
  }
  return result;
}

void define_tool(py::module_& module) {
  using py::arg;
  constexpr const char* kSpacing = "spacing: of the samples, m; half of the cloud's R or less";
  py::class_<Tool, std::shared_ptr<Tool>>(
      module, "Tool",
      "A rigid tool or a gripper with two fingers, as samples of its surface. Experimental. "
      "\"ball:R\", "
      "\"capsule:LxR\", \"cylinder:LxR\", \"box:XxYxZ\" or \"gripper:XxYxZ\", sizes in mm")
      .def(py::init([](const std::string& shape, double spacing) {
             return std::make_shared<Tool>(Tool::from_text(shape, spacing));
           }),
           arg("shape"), py::kw_only(), arg("spacing"), kSpacing)
      .def_static(
          "mesh",
          [](const py::object& vertices, const py::array_t<std::int64_t>& triangles,
             double spacing) {
            return std::make_shared<Tool>(
                Tool::mesh(points_of(vertices), triangles_of(triangles), spacing));
          },
          arg("vertices"), arg("triangles"), py::kw_only(), arg("spacing"),
          "vertices: (n, 3), m, from the handle. triangles: (m, 3). spacing: of the samples, m")
      .def("__len__", [](const Tool& tool) { return tool.samples().size(); })
      .def("__repr__",
           [](const Tool& tool) {
             return fmt::format("<palpate.Tool: {} samples, {:.3g} m from the handle>",
                                tool.samples().size(), tool.extent());
           })
      .def_property_readonly(
          "samples",
          [](const Tool& tool) {
            Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> all(tool.samples().size(), 3);
            for (std::size_t i = 0; i < tool.samples().size(); ++i) {
              all.row(static_cast<Eigen::Index>(i)) = tool.samples()[i].position.transpose();
            }
            return all;
          },
          "(n, 3), m, from the handle at an opening of 0")
      .def_property_readonly("extent", &Tool::extent, "m, from the handle")
      .def_property_readonly("gyration", &Tool::gyration, "radius about the handle, m");
}

// One of the vectors of each touch.
auto vectors_of(Eigen::Vector3d ToolContact::Touch::*member) {
  return [member](const ToolContact& contact) {
    return of_touches(contact, {3}, [member](const ToolContact::Touch& touch) {
      return std::span<const double>((touch.*member).data(), 3);
    });
  };
}

void define_touches(py::class_<ToolContact>& type) {
  using Touch = ToolContact::Touch;
  type.def_property_readonly("positions", vectors_of(&Touch::position),
                             "(n, 3) where samples press, m; n is at most 7")
      .def_property_readonly("normals", vectors_of(&Touch::normal),
                             "(n, 3) of the surface there, outward, unit")
      .def_property_readonly(
          "forces",
          [](const ToolContact& contact) {
            return of_touches(contact, {},
                              [](const Touch& touch) { return std::span(&touch.force, 1); });
          },
          "(n,) along the normals, N")
      .def_property_readonly("frictions", vectors_of(&Touch::friction),
                             "(n, 3) along the surface, N");
}

void define_contact(py::module_& module) {
  py::class_<ToolContact> type(module, "ToolContact", "What one tick of a tool gave; world frame");
  type.def("__repr__",
           [](const ToolContact& contact) {
             if (!contact.touching) return std::string("<palpate.ToolContact: touches nothing>");
             return fmt::format("<palpate.ToolContact: {:.4g} N, {:.4g} N m>",
                                contact.wrench.force.norm(), contact.wrench.torque.norm());
           })
      .def_property_readonly(
          "force", [](const ToolContact& contact) { return contact.wrench.force; },
          "(3,) on the hand, N")
      .def_property_readonly(
          "torque", [](const ToolContact& contact) { return contact.wrench.torque; },
          "(3,) on the hand, about the handle, N m")
      .def_property_readonly(
          "grip", [](const ToolContact& contact) { return contact.wrench.grip; },
          "on a gripper's opening, N; above 0 it opens")
      .def_property_readonly(
          "pose", [](const ToolContact& contact) { return matrix_of(contact.proxy); },
          "(4, 4) of the tool, which stays outside")
      .def_property_readonly(
          "opening", [](const ToolContact& contact) { return contact.proxy.opening; }, "m")
      .def_readonly("touching", &ToolContact::touching)
      .def_readonly("sliding", &ToolContact::sliding, "friction yielded")
      .def_readonly("stiffness", &ToolContact::stiffness, "N/m")
      .def_property_readonly(
          "notes",
          [](const ToolContact& contact) { return static_cast<std::uint32_t>(contact.notes); },
          "bits; note_names() names them");
  define_touches(type);
}

ToolOptions options_of(double stiffness, double gyration, double friction_dynamic,
                       std::optional<double> friction_static, double friction_viscous,
                       double texture_amplitude, double texture_wavelength) {
  return {
      .stiffness = stiffness,
      .friction = {friction_static.value_or(friction_dynamic), friction_dynamic, friction_viscous},
      .texture = {texture_amplitude, texture_wavelength},
      .gyration = gyration};
}

template <class... Options>
std::unique_ptr<HeldTool> in_scene(std::shared_ptr<Tool> tool, std::shared_ptr<SharedScene> scene,
                                   Options... options) {
  SharedScene& shared = *scene;
  const Away away(shared.mutex);
  return std::make_unique<HeldTool>(std::move(tool), std::move(scene), options_of(options...));
}

template <class... Options>
std::unique_ptr<HeldTool> on_formula(std::shared_ptr<Tool> tool, std::shared_ptr<AnyField> field,
                                     Options... options) {
  if (field->of_scene() != nullptr) {
    throw py::type_error("a Field serves one point; give the scene itself: ToolProxy(tool, scene)");
  }
  return std::make_unique<HeldTool>(std::move(tool), std::move(field), options_of(options...));
}

template <class Make>
void define_constructor(py::class_<HeldTool>& type, Make make, const char* touched) {
  using py::arg;
  constexpr const char* kOptions =
      "stiffness: N/m. gyration: m, turns have stiffness times its square (N m/rad); 0: the "
      "tool's. "
      "friction_dynamic, friction_static (default: the dynamic one): coefficients. "
      "friction_viscous: N s/m. texture_amplitude, texture_wavelength: m";
  type.def(py::init(make), arg("tool").none(false), arg(touched).none(false), py::kw_only(),
           arg("stiffness") = 500.0, arg("gyration") = 0.0, arg("friction_dynamic") = 0.0,
           arg("friction_static") = py::none(), arg("friction_viscous") = 0.0,
           arg("texture_amplitude") = 0.0, arg("texture_wavelength") = Texture().wavelength,
           kOptions);
}

}  // namespace

void define_tools(py::module_& module) {
  using py::arg;
  define_tool(module);
  define_contact(module);
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  py::class_<HeldTool> type(
      module, "ToolProxy",
      "A tool that follows the hand, turns, and stays outside of a scene's surface or "
      "of a formula's. Experimental. Input that is not finite is a fault: no wrench "
      "until reset()");
  using Maybe = std::optional<double>;
  define_constructor(type, &in_scene<double, double, double, Maybe, double, double, double>,
                     "scene");
  define_constructor(type, &on_formula<double, double, double, Maybe, double, double, double>,
                     "field");
  type.def("__repr__",
           [](const HeldTool& held) {
             return fmt::format("<palpate.ToolProxy: {} N/m, gyration {:.3g} m>",
                                held.options().stiffness, held.options().gyration);
           })
      .def(
          "step",
          [](HeldTool& held, const Eigen::MatrixXd& pose, double dt, double opening) {
            return held.step(hand_pose(pose, opening), dt);
          },
          arg("pose"), arg("dt") = 1e-3, py::kw_only(), arg("opening") = 0.0,
          "One tick: pose (4, 4) of the hand, world; dt s; opening of a gripper, m")
      .def(
          "reset",
          [](HeldTool& held, const Eigen::MatrixXd& pose, double opening) {
            held.reset(hand_pose(pose, opening));
          },
          arg("pose") = identity, py::kw_only(), arg("opening") = 0.0,
          "Puts it there, in free space; forgets contact and faults")
      .def_property_readonly("time", &HeldTool::time,
                             "of the next tick, s: what the stamps of push() are compared with");
}

}  // namespace palpate::python
