#include "scene.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "clouds.hpp"
#include "gil.hpp"
#include "images.hpp"
#include "module.hpp"
#include "options.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate::python {
namespace {

using ScenePointer = std::shared_ptr<SharedScene>;

// A surface that is pushed without a stamp is felt so long after it is ready, s.
constexpr double kLead = 2e-3;
constexpr double kLatency = 0.01;  // s from a stamp to its surface, in simulated time

// A source more; `parts`: what Scene::add() takes.
template <class Made, class... Parts>
std::shared_ptr<Made> added(const ScenePointer& scene, const Parts&... parts) {
  const Away away(scene->mutex);
  auto made = std::make_shared<Made>();
  made->scene = scene;
  made->source = &scene->scene.add(parts...);
  made->index = scene->scene.size() - 1;
  scene->pushed.resize(scene->scene.size());
  return made;
}

std::shared_ptr<SharedSource> add_cloud(const ScenePointer& scene, const std::string& name,
                                        const py::object& given_cloud, const Eigen::MatrixXd& pose,
                                        const py::kwargs& given) {
  Keywords keywords(given, "Scene.add");
  SourceOptions options;
  options.T_world_sensor = pose_of(pose);
  const auto cloud = cloud_of(given_cloud, keywords);
  take(keywords, options.prepare);
  keywords.take("organised", options.organised);
  keywords.take("soft_stiffness", options.soft.stiffness_factor);
  keywords.take("soft_friction", options.soft.friction_factor);
  keywords.finish();
  return added<SharedSource>(scene, name, *cloud, options);
}

std::shared_ptr<CloudStream> add_stream(const ScenePointer& scene, const std::string& name,
                                        const Eigen::MatrixXd& pose, const py::kwargs& given) {
  Keywords keywords(given, "Scene.add_stream");
  SourceOptions options;
  options.T_world_sensor = pose_of(pose);
  take(keywords, options.prepare);
  take(keywords, options.policy);
  keywords.finish();
  return added<CloudStream>(scene, name, options);
}

std::array<double, 4> lens_of(const py::object& K) {
  try {
    return K.cast<std::array<double, 4>>();
  } catch (const py::cast_error&) {
    const bool matrix = py::isinstance<py::array>(K) && K.cast<py::array>().size() == 9;
    throw py::type_error(matrix ? "K has shape (3, 3); give (K[0, 0], K[1, 1], K[0, 2], K[1, 2])"
                                : fmt::format("K is {}; give (fx, fy, cx, cy), pixels",
                                              py::repr(K).cast<std::string>()));
  }
}

CameraModel model_of(const std::array<double, 4>& K, const std::array<int, 2>& size,
                     const std::array<double, 5>& lens) {
  CameraModel model{size[0], size[1], {K[0], K[1], K[2], K[3]}, {}};
  model.distortion = {lens[0], lens[1], lens[2], lens[3], lens[4]};
  return model;
}

std::shared_ptr<Camera> add_camera(const ScenePointer& scene, const std::string& name,
                                   const py::object& K, const std::array<int, 2>& size,
                                   const Eigen::MatrixXd& pose, double unit,
                                   const std::array<double, 5>& distortion,
                                   const py::kwargs& given) {
  Keywords keywords(given, "Scene.add_camera");
  SourceOptions options;
  options.T_world_sensor = pose_of(pose);
  keywords.take("radius", options.prepare.radius);
  take(keywords, options.policy);
  take(keywords, options.depth);
  keywords.finish();
  const std::array<double, 4> lens = lens_of(K);
  auto camera = added<Camera>(scene, name, options);
  camera->model = model_of(lens, size, distortion);
  camera->unit = unit;
  camera->range = options.depth;
  return camera;
}

// Starts by simulated time if there is a stamp, else by the servos' clock.
Source::StartTime start_of(SharedSource& source, const std::optional<double>& stamp,
                           double latency) {
  return [&source, stamp, latency] {
    const double start = stamp ? *stamp + latency : SteadyClock().now() + kLead;
    source.starts(start);
    return start;
  };
}

bool push_image(Camera& camera, const py::object& depth, const std::optional<double>& stamp,
                double latency, const std::optional<Eigen::MatrixXd>& pose) {
  const py::array image =
      readable(depth, "depth", {kUint16, kFloat32}, {camera.model.height, camera.model.width});
  const Away away(camera.mutex);
  camera.frame.stamp = stamp.value_or(SteadyClock().now());
  if (camera.frame.stamp < camera.newest) {
    throw Error(fmt::format("stamp {} s is older than the image before, {} s: push images in order",
                            camera.frame.stamp, camera.newest));
  }
  take_image(image, camera);
  camera.frame.T_world_sensor.reset();
  if (pose) camera.frame.T_world_sensor = pose_of(*pose);
  camera.tell(problem_of(camera, image.itemsize() != kFloat32.bytes));
  const bool taken = camera.source->push(camera.frame, start_of(camera, stamp, latency));
  camera.newest = camera.frame.stamp;
  return taken;
}

bool push_points(CloudStream& stream, const py::object& points, const std::optional<double>& stamp,
                 double latency, const std::optional<Eigen::MatrixXd>& pose,
                 const py::kwargs& given) {
  Keywords keywords(given, "CloudStream.push");
  const auto cloud = cloud_of(points, keywords);
  keywords.finish();
  const Away away(stream.mutex);
  if (pose) stream.source->set_pose(pose_of(*pose));
  return stream.source->push(*cloud, stamp.value_or(SteadyClock().now()),
                             start_of(stream, stamp, latency));
}

std::size_t size_of(SharedScene& scene) {
  const Away away(scene.mutex);
  return scene.scene.size();
}

SourceState state_of(SharedScene& scene, std::size_t index) {
  if (index >= size_of(scene)) throw py::index_error("there is no such source");
  const Away away(scene.mutex);
  return {scene.scene.state(index), scene.pushed[index].problem_at(scene.time)};
}

py::object points_of(const SharedSource& source) {
  const auto points = source.source->points();
  return points ? shared(points) : py::none();
}

std::string words(const Source& source) {
  const auto points = source.points();
  return fmt::format("{} ({} points)", source.name(), points ? points->size() : 0);
}

std::string words(const SharedSource& source) {
  return fmt::format("<palpate source {}>", words(*source.source));
}

std::string words(SharedScene& scene) {
  const Away away(scene.mutex);
  std::string text;
  for (std::size_t i = 0; i < scene.scene.size(); ++i) {
    text += (i > 0 ? ", " : "") + words(scene.scene.source(i));
  }
  return fmt::format("<palpate.Scene: {}>", text.empty() ? "no source" : text);
}

void define_state(py::module_& module) {
  using State = SourceState;
  py::class_<State>(module, "SourceState", "State of a source; times in s, lengths in m")
      .def_readonly("frames", &State::frames, "frames and clouds that became a surface")
      .def_readonly("dropped", &State::dropped, "dropped because stalled fields held all snapshots")
      .def_readonly("slowest", &State::slowest, "name of a stalled field at the last drop")
      .def_readonly("interval", &State::interval, "time between frames, smoothed; 0: none yet")
      .def_readonly("latency", &State::latency, "of the last one, from its stamp to its surface")
      .def_readonly("stamp", &State::stamp)
      .def_readonly("points", &State::points)
      .def_readonly("noise", &State::noise, "sigma of one pixel at `depth`")
      .def_readonly("depth", &State::depth, "median of the last frame")
      .def_readonly("disagreement", &State::disagreement,
                    "with other sources; None: nothing shared")
      .def_readonly(
          "problem", &State::problem,
          "why nothing is felt of what was pushed last, and what to do; empty: none is known")
      .def("__repr__", [](const State& state) {
        return fmt::format("<{} frames at {:.1f} Hz, {} dropped, {} points{}{}>", state.frames,
                           state.rate(), state.dropped, state.points,
                           state.problem.empty() ? "" : "; ", state.problem);
      });
}

constexpr const char* kPushPoints = R"(Takes the next cloud.

points: (n, 3) m, with the keywords of PointCloud, or a PointCloud. stamp: when it was taken, s; its surface is
felt from stamp + latency on. Without a stamp it was taken now (time.monotonic()) and is felt as soon as it is
ready. pose: (4, 4), sensor to world. False: it was dropped, because stalled fields hold all snapshots.)";

constexpr const char* kPushImage = R"(Takes the next image, without the GIL.

depth: (height, width) uint16 in the camera's unit, or float32 in m; 0: nothing measured. The rest is as
CloudStream.push() has it; pose is that at the stamp. Error: the stamp is older than the one before.)";

constexpr const char* kAdd = R"(Prepares a static cloud.

cloud: an (n, 3) array with the keywords of PointCloud, a PointCloud, or a file's path. pose: (4, 4), cloud to
world. Keywords: those of prepare(); organised=False for a depth image's points that are to be a loose cloud.
Sources are added before the first Field or Servo.)";

constexpr const char* kAddStream = R"(A sensor whose clouds are pushed.

Keywords: {}, those of prepare().)";

constexpr const char* kAddCamera = R"(A depth camera whose images are pushed.

K: (fx, fy, cx, cy), pixels; size: (width, height); pose: (4, 4), camera (x right, y down, z forward) to world;
unit: metres a step of uint16 images; distortion: (k1, k2, p1, p2, k3). Keywords: radius (m),
{}, {}.)";

void define_sources(py::module_& module) {
  using py::arg;
  using Shared = SharedSource;
  py::class_<Shared, std::shared_ptr<Shared>>(module, "Source", "One cloud or sensor of a scene")
      .def("__repr__", [](const Shared& source) { return words(source); })
      .def_property_readonly("name", &Shared::name)
      .def_property_readonly("pose", &Shared::pose, "(4, 4), sensor to world")
      .def("set_pose", &Shared::set_pose, arg("pose"), "From the next push on: (4, 4)")
      .def("points", &points_of, "SurfacePoints of the newest surface, not copied, or None")
      .def("report", &Shared::report, "PrepareReport of the newest cloud")
      .def("state", &Shared::state, py::call_guard<Released>())
      .def("keep", &Shared::keep, py::call_guard<Released>(),
           "Keeps the last surface without fading: after the last push");
  py::class_<CloudStream, Shared, std::shared_ptr<CloudStream>>(module, "CloudStream",
                                                                "A sensor that delivers points")
      .def("push", &push_points, arg("points"), arg("stamp") = py::none(), py::kw_only(),
           arg("latency") = kLatency, arg("pose") = py::none(), kPushPoints);
  py::class_<Camera, Shared, std::shared_ptr<Camera>>(module, "Camera", "A depth camera")
      .def("push", &push_image, arg("depth"), arg("stamp") = py::none(), py::kw_only(),
           arg("latency") = kLatency, arg("pose") = py::none(), kPushImage);
}

}  // namespace

void SharedSource::set_pose(const Eigen::MatrixXd& T_world_sensor) {
  source->set_pose(pose_of(T_world_sensor));
}

SourceState SharedSource::state() const {
  const std::lock_guard lock(scene->mutex);
  return {source->state(), scene->pushed[index].problem_at(scene->time)};
}

void SharedSource::tell(std::string problem) {
  const std::lock_guard lock(scene->mutex);
  scene->pushed[index].problem = std::move(problem);
}

void SharedSource::starts(double start) {
  const PolicyOptions policy = source->options().policy;
  const std::lock_guard lock(scene->mutex);
  scene->pushed[index].starts(start, start + policy.silence + policy.fade, scene->time);
}

void SharedSource::keep() {
  const std::lock_guard lock(mutex);
  source->keep();
}

void define_scene(py::module_& module) {
  using py::arg;
  define_state(module);
  define_sources(module);
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  py::class_<SharedScene, ScenePointer>(module, "Scene", "Up to eight sources touched together")
      .def(py::init())
      .def("__len__", &size_of)
      .def("__repr__", [](SharedScene& scene) { return words(scene); })
      .def("add", &add_cloud, arg("name"), arg("cloud"), arg("pose") = identity, kAdd)
      .def("add_stream", &add_stream, arg("name"), arg("pose") = identity,
           fmt::format(kAddStream, listed(keywords_of<PolicyOptions>())).c_str())
      .def("add_camera", &add_camera, arg("name"), py::kw_only(), arg("K"), arg("size"),
           arg("pose") = identity, arg("unit") = 1e-3, arg("distortion") = std::array<double, 5>{},
           fmt::format(kAddCamera, listed(keywords_of<PolicyOptions>()),
                       listed(keywords_of<DepthFilterOptions>()))
               .c_str())
      .def("state", &state_of, arg("index"), "SourceState, with its distance to other sources");
}

}  // namespace palpate::python
