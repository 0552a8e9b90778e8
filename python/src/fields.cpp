#include "fields.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"

namespace palpate::python {
namespace {

/// The surface of a scene, which it keeps.
class ScenesField final : public AnyField {
 public:
  ScenesField(std::shared_ptr<SharedScene> scene, const FieldOptions& options)
      : scene_(std::move(scene)), field_(scene_->scene, options) {}

  [[nodiscard]] const Field& field() const noexcept override { return field_; }
  void stepped(double now) noexcept override { scene_->time.store(now); }
  [[nodiscard]] SceneField* of_scene() noexcept override { return &field_; }

 private:
  std::shared_ptr<SharedScene> scene_;
  SceneField field_;
};

/// A shape given by a formula.
template <class Shape>
class Formula final : public AnyField {
 public:
  template <class... Sizes>
  explicit Formula(const AnalyticField::Options& options, Sizes... sizes)
      : shape_(sizes..., options) {}
  [[nodiscard]] const Field& field() const noexcept override { return shape_; }

 private:
  Shape shape_;
};

std::unique_ptr<ScenesField> scene_field(const std::shared_ptr<SharedScene>& scene,
                                         const py::kwargs& given) {
  Keywords keywords(given, "Field");
  FieldOptions options;
  take(keywords, options);
  keywords.finish();
  const Away away(scene->mutex);
  return std::make_unique<ScenesField>(scene, options);
}

// Evaluates the field at x and hands each sample to `put`. `viewer`: where the tool is that looks
// at surfaces with two sides; none: at x itself.
template <class Put>
void each_sample(AnyField& any, const Vectors& x, const std::optional<Eigen::Vector3d>& viewer,
                 double time, const Put& put) {
  const Away away(any.mutex);
  SceneField* const of_scene = any.of_scene();
  const auto look_from = [=](const Eigen::Vector3d& place) {
    if (of_scene) of_scene->update_from(time, place, place);
  };
  if (viewer) look_from(*viewer);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % kUninterrupted == kUninterrupted - 1) hear_signals();
    if (!viewer) look_from(x[i]);
    put(i, any.field().sample(x[i]));
  }
}

py::array_t<double> values(AnyField& any, const py::object& given,
                           const std::optional<Eigen::Vector3d>& viewer, double time) {
  const Vectors x(given, "x");
  py::array_t<double> result(static_cast<py::ssize_t>(x.size()));
  double* const out = result.mutable_data();
  each_sample(any, x, viewer, time, [out](std::size_t i, const Sample& s) { out[i] = s.value; });
  return result;
}

py::array_t<double> gradients(AnyField& any, const py::object& given,
                              const std::optional<Eigen::Vector3d>& viewer, double time) {
  const Vectors x(given, "x");
  py::array_t<double> result({static_cast<py::ssize_t>(x.size()), py::ssize_t{3}});
  double* const out = result.mutable_data();
  each_sample(any, x, viewer, time, [out](std::size_t i, const Sample& s) {
    Eigen::Map<Eigen::Vector3d>(out + 3 * i) = s.gradient;
  });
  return result;
}

AnalyticField::Options formula_options(const Eigen::MatrixXd& pose, double tool_radius) {
  AnalyticField::Options options;
  options.T_world_shape = pose_of(pose);
  options.tool_radius = tool_radius;
  return options;
}

template <class Shape, class... Sizes, class... Names>
void define_formula(py::module_& module, const char* name, const char* words,
                    const Names&... names) {
  using Bound = Formula<Shape>;
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  py::class_<Bound, AnyField, std::shared_ptr<Bound>>(module, name, words)
      .def(py::init([](Sizes... sizes, const Eigen::MatrixXd& pose, double tool_radius) {
             return std::make_shared<Bound>(formula_options(pose, tool_radius), sizes...);
           }),
           names..., py::arg("pose") = identity, py::kw_only(), py::arg("tool_radius") = 0.0,
           "pose: (4, 4), shape to world; tool_radius: of the proxy's ball, m")
      .def("__repr__", [name](const Bound&) { return fmt::format("<palpate.{}>", name); });
}

}  // namespace

void define_fields(py::module_& module) {
  constexpr const char* kAsked =
      "x: (n, 3), m. seen_from: (3,), where the tool is that "
      "looks at surfaces with "
      "two sides, which are free on its side; None: at x itself. time: s";
  py::class_<AnyField, std::shared_ptr<AnyField>>(
      module, "AnyField",
      "An implicit function of place: free where its value is above 0, solid elsewhere")
      .def("value", &values, py::arg("x"), py::arg("seen_from") = py::none(), py::arg("time") = 0.0,
           fmt::format("(n,) float64, m, length-like. {}", kAsked).c_str())
      .def("gradient", &gradients, py::arg("x"), py::arg("seen_from") = py::none(),
           py::arg("time") = 0.0,
           fmt::format("(n, 3) float64, outward, d value / d x. {}", kAsked).c_str());
  py::class_<ScenesField, AnyField, std::shared_ptr<ScenesField>>(
      module, "Field",
      fmt::format("The surface of a scene, by kind. Keywords: paper, {}. One thread uses it at a "
                  "time; others wait.",
                  listed(keywords_of<FieldOptions>()))
          .c_str())
      .def(py::init(&scene_field), py::arg("scene"))
      .def("__repr__", [](ScenesField& field) {
        return fmt::format("<palpate.Field: tool radius {} m>",
                           field.of_scene()->options().tool_radius);
      });
  define_formula<PlaneField>(module, "Plane", "The half-space z <= 0");
  define_formula<SphereField, double>(module, "Sphere", "A ball around the origin; radius in m",
                                      py::arg("radius"));
  define_formula<BoxField, Eigen::Vector3d>(
      module, "Box", "A box around the origin; size (3,) in m", py::arg("size"));
  define_formula<TorusField, double, double>(
      module, "Torus", "A tube of radius `tube` around a circle of radius `ring` about z, m",
      py::arg("ring"), py::arg("tube"));
}

}  // namespace palpate::python
