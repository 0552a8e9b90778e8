// Figure 7 of the paper: how much the force varies with the number of clouds averaged.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/paper/paper_command.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/geometry/spacing.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/stream.hpp"
#include "session/frames.hpp"

namespace palpate::app {

namespace {

using Eigen::Vector3d;

constexpr int kMostClouds = 4;        // N of the paper's figure
constexpr double kPressDepth = 4e-3;  // of the hand under the surface, m
constexpr double kHigh = 20e-3;       // of the hand above it at first, m
constexpr double kDown = 0.4;         // when the hand is down, s
constexpr double kSettled = 1;        // when the samples begin, s
constexpr double kPeriod = 1e-3;      // of the servo, s
constexpr double kAround = 0.08;      // half of the box that the paper's clouds are clipped to, m
constexpr double kFitRadius = 0.04;   // of the points that set the surface's normal, m
constexpr int kMiddle = 8;            // pixels to either side of the image's middle

// The test point, world frame, and the directions that variability is measured along.
struct TestPoint {
  Vector3d point = Vector3d::Zero();
  Vector3d point_in_camera = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();
  Vector3d tangent_x = Vector3d::UnitX();
  Vector3d tangent_y = Vector3d::UnitY();
};

Vector3d normal_of(const PointCloud& cloud, const Vector3d& middle) {
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  double count = 0;
  for (const Eigen::Vector3f& p : cloud.positions) {
    const Vector3d d = p.cast<double>() - middle;
    if (d.norm() > kFitRadius) continue;
    mean += d;
    square += d * d.transpose();
    ++count;
  }
  mean /= count;
  const Eigen::Matrix3d covariance = square / count - mean * mean.transpose();
  const Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
  return normal.dot(middle) < 0 ? normal : -normal;
}

// Median depth of the pixels in the middle of the image, m.
double depth_in_the_middle(const DepthFrame& frame) {
  std::vector<float> depths;
  const int u = frame.camera.width / 2;
  const int v = frame.camera.height / 2;
  for (int row = std::max(0, v - kMiddle); row < std::min(frame.camera.height, v + kMiddle);
       ++row) {
    for (int column = std::max(0, u - kMiddle); column < std::min(frame.camera.width, u + kMiddle);
         ++column) {
      const auto at = static_cast<std::size_t>(row * frame.camera.width + column);
      if (frame.depth[at] > 0) depths.push_back(frame.depth[at]);
    }
  }
  if (depths.empty()) {
    throw Error("the frame has no depth at the centre of its image; choose another source");
  }
  return median(depths);
}

TestPoint test_point_of(const DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  const double z = depth_in_the_middle(frame);
  const double u = 0.5 * (frame.camera.width - 1);
  const double v = 0.5 * (frame.camera.height - 1);
  const Eigen::Isometry3d pose = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
  TestPoint target;
  target.point_in_camera = Vector3d((u - p.cx) * z / p.fx, (v - p.cy) * z / p.fy, z);
  target.point = pose * target.point_in_camera;
  target.normal = pose.linear() * normal_of(session::cloud_of(frame), target.point_in_camera);
  const Vector3d ahead = pose.linear().col(2);
  Vector3d along = ahead - target.normal * target.normal.dot(ahead);
  if (along.norm() < 1e-3) along = pose.linear().col(0);
  target.tangent_x = along.normalized();
  target.tangent_y = target.normal.cross(target.tangent_x);
  return target;
}

// A field and a proxy on one of the scenes.
struct Feeler {
  Feeler(Scene& felt, const FieldOptions& field_options, const ProxyOptions& proxy_options)
      : scene(felt), field(felt, field_options), proxy(proxy_options) {}

  Scene& scene;
  SceneField field;
  Proxy proxy;
  Press press;
  Vector3d last_force = Vector3d::Zero();
};

// Nine methods that feel the same frames.
class Feelers {
 public:
  Feelers(const TestPoint& target, const Fig7Options& options) : target_(target) {
    for (int n = 1; n <= kMostClouds; ++n) add_clouds(n, options);
    ours_.add("camera");
    for (const FieldOptions::Kind kind :
         {FieldOptions::Kind::metaball, FieldOptions::Kind::pointset}) {
      for (int n = 1; n <= kMostClouds; ++n) add_paper(kind, n);
    }
    feelers_.emplace_back(ours_, FieldOptions{}, ProxyOptions{});
    feelers_.back().press.name = "palpate";
  }

  void push(const DepthFrame& frame, const Source::StartTime& start) {
    const PointCloud cloud = session::cloud_of(frame);
    for (Scene& scene : clouds_) {
      if (frame.T_world_sensor) scene.source(0).set_pose(*frame.T_world_sensor);
      scene.source(0).push(cloud, frame.stamp, start);
    }
    ours_.source(0).push(frame, start);
  }

  void step(double time, const Vector3d& hip, bool sampled) {
    for (Feeler& feeler : feelers_) step(feeler, time, hip, sampled);
  }

  [[nodiscard]] std::vector<Press> presses() {
    std::vector<Press> presses;
    for (Feeler& feeler : feelers_) {
      const auto points = feeler.scene.source(0).points();
      if (points) feeler.press.radius = points->radius;
      presses.push_back(std::move(feeler.press));
    }
    return presses;
  }

 private:
  void add_clouds(int n, const Fig7Options& wanted) {
    SourceOptions options;
    options.policy.policy = Policy::average;
    options.policy.history = n;
    options.prepare.paper = true;
    options.prepare.voxel = wanted.voxel;
    options.prepare.radius = wanted.radius;
    options.prepare.clip.emplace();
    options.prepare.clip->extend(target_.point_in_camera - Vector3d::Constant(kAround));
    options.prepare.clip->extend(target_.point_in_camera + Vector3d::Constant(kAround));
    clouds_.emplace_back().add("clouds", options);
  }

  void add_paper(FieldOptions::Kind kind, int n) {
    ProxyOptions proxy;
    proxy.method = ProxyOptions::Method::single_step;
    feelers_.emplace_back(clouds_[static_cast<std::size_t>(n) - 1], paper_field(kind), proxy);
    feelers_.back().press.name = kind == FieldOptions::Kind::metaball ? "metaball" : "point-set";
    feelers_.back().press.clouds = n;
  }

  void step(Feeler& feeler, double time, const Vector3d& hip, bool sampled) const {
    feeler.field.update(time, hip, feeler.proxy);
    const Contact contact = feeler.proxy.step(feeler.field, hip, kPeriod);
    Press& press = feeler.press;
    if (sampled) {
      const Sample sample = feeler.field.sample(contact.proxy);
      const Vector3d normal = sample.gradient.normalized();
      press.samples.push_back({target_.normal.dot(contact.proxy - target_.point),
                               normal.dot(target_.tangent_x), normal.dot(target_.tangent_y),
                               contact.force.norm()});
      press.jump = std::max(press.jump, (contact.force - feeler.last_force).norm());
      press.touching += contact.touching ? 1 : 0;
    }
    feeler.last_force = contact.force;
  }

  TestPoint target_;
  std::deque<Scene> clouds_;  // of N = 1, 2, ...
  Scene ours_;
  std::deque<Feeler> feelers_;
};

Vector3d hand_at(const TestPoint& target, double time) {
  const double down = std::clamp((time - 0.1) / (kDown - 0.1), 0.0, 1.0);
  return target.point + (kHigh - down * (kHigh + kPressDepth)) * target.normal;
}

template <class Get>
double deviation(const std::vector<PressSample>& samples, Get get) {
  double sum = 0;
  double square = 0;
  for (const PressSample& each : samples) sum += get(each);
  const double mean = sum / static_cast<double>(samples.size());
  for (const PressSample& each : samples) square += (get(each) - mean) * (get(each) - mean);
  return std::sqrt(square / static_cast<double>(samples.size()));
}

void sum_up(Press& press) {
  if (press.samples.empty()) return;
  double mean = 0;
  for (const PressSample& each : press.samples) mean += each.height;
  mean /= static_cast<double>(press.samples.size());
  for (PressSample& each : press.samples) each.height -= mean;
  press.height_sd = deviation(press.samples, [](const PressSample& s) { return s.height; });
  press.nx_sd = deviation(press.samples, [](const PressSample& s) { return std::asin(s.nx); });
  press.ny_sd = deviation(press.samples, [](const PressSample& s) { return std::asin(s.ny); });
  press.touching /= static_cast<double>(press.samples.size());
}

// Every method feels every frame of the press, or they could not be compared.
void check(const StreamState& stream, double time, double whole) {
  if (stream.phase == StreamState::Phase::ended) {
    throw Error(
        fmt::format("{} ended after {} frames, before the press of {} s; give a shorter --duration "
                    "or a longer recording{}",
                    stream.camera, stream.frames, whole,
                    stream.problem.empty() ? "" : " (" + stream.problem + ")"));
  }
  if (stream.phase != StreamState::Phase::failed && stream.phase != StreamState::Phase::stalled)
    return;
  throw Error(
      fmt::format("the press failed after {:.3g} of {} s: {}", time, whole, stream.problem));
}

}  // namespace

Fig7 measure_fig7(DepthCamera& camera, const Fig7Options& options) {
  const DepthFrame frame = first_frame(camera);
  const TestPoint target = test_point_of(frame);
  Feelers feelers(target, options);
  Fig7 result;
  result.depth = target.point_in_camera.z();
  result.voxel = options.voxel;
  result.radius_given = options.radius.has_value();
  const Eigen::Isometry3d pose = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
  result.angle = std::asin(std::min(1.0, std::abs(pose.linear().col(2).dot(target.normal))));
  const double whole = kSettled + options.duration;
  const int steps = static_cast<int>(std::lround(whole / kPeriod));
  Progress progress("pressing");
  SimulatedStream stream(
      camera, "the press",
      [&](const DepthFrame& next, const Source::StartTime& start) { feelers.push(next, start); });
  for (int i = 0; i < steps; ++i) {
    const double time = i * kPeriod;
    stream.advance(time);
    check(stream.state(), time, whole);
    progress.update(static_cast<double>(i) / steps);
    const bool sampled = time >= kSettled;
    if (sampled) result.times.push_back(time);
    feelers.step(time, hand_at(target, time), sampled);
  }
  result.frames = stream.state().touchable;
  result.presses = feelers.presses();
  for (Press& press : result.presses) sum_up(press);
  return result;
}

}  // namespace palpate::app
