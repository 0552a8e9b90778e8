// Rows of bodies that a camera saw from one side.
#include <algorithm>
#include <array>

#include "accuracy/rows.hpp"
#include "accuracy/truth_frame.hpp"
#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"
#include "sim/simulated_depth.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 110;
constexpr int kHeight = 90;
constexpr double kFocal = 200;  // pixels; at this distance they are a spacing apart
constexpr double kWall = 240;   // before it stands the object, at the distance of the focal length

constexpr double kMillimetres = 1e3;

// The points of a depth image in its own order, and how far each pixel's neighbours differ.
class Image {
 public:
  explicit Image(const std::array<Solid, 2>& solids) {
    const CameraModel camera{kWidth, kHeight, {kFocal, kFocal, kWidth / 2.0, kHeight / 2.0}, {}};
    DepthRenderer(camera, 2 * kWall).render(solids, Eigen::Isometry3d::Identity(), depth_);
  }

  [[nodiscard]] Vector3d point(int u, int v) const {
    const double z = depth_[static_cast<std::size_t>(v * kWidth + u)];
    return {(u - kWidth / 2.0) / kFocal * z, (v - kHeight / 2.0) / kFocal * z, z};
  }

  // Is one surface seen all around?
  [[nodiscard]] bool is_inner(int u, int v) const {
    constexpr int kAround = 4;
    constexpr double kSmooth = 8;  // a jump is larger
    double least = point(u, v).z();
    double most = least;
    for (int i = -kAround; i <= kAround; ++i) {
      for (int k = -kAround; k <= kAround; ++k) {
        if (u + i < 0 || u + i >= kWidth || v + k < 0 || v + k >= kHeight) return false;
        least = std::min(least, point(u + i, v + k).z());
        most = std::max(most, point(u + i, v + k).z());
      }
    }
    return most - least < kSmooth;
  }

 private:
  std::vector<float> depth_;
};

// An object before a wall, seen from one place: what it hides has no points.
void draw_partial(Draft& draft, SolidKind kind, bool seen, double noise) {
  Solid object{kind, Eigen::Isometry3d::Identity(), Vector3d(18, 14, 10)};
  object.T_world_solid.translation() = Vector3d(0, 0, kFocal + 18);
  const double turn = draft.between(0, 1.5);
  object.T_world_solid.rotate(Eigen::AngleAxisd(turn, draft.direction()));
  Solid wall;
  wall.T_world_solid.translation() = Vector3d(0, 0, kWall);
  wall.T_world_solid.rotate(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitX()));
  draft.truth = unite(of(object), of(wall));
  const Image image({object, wall});
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Vector3d point = image.point(u, v);
      if (point.z() > 0) draft.add(point, -point.normalized());
    }
  }
  draft.noise = noise;
  if (seen) draft.viewpoint = Vector3d::Zero();
  for (int i = 0; i < 20;) {
    const int u = static_cast<int>(draft.between(0, kWidth));
    const int v = static_cast<int>(draft.between(0, kHeight));
    if (!image.is_inner(u, v)) continue;
    const Vector3d point = image.point(u, v);
    push(draft, point * (1 - 12 / point.norm()), point * (1 + 3 / point.norm()));
    ++i;
  }
}

// The sphere of the accuracy bench's scene, as points of its noisy depth frame; millimetres.
void draw_table(Draft& draft, bool seen) {
  constexpr double kMargin = 0.07;  // of points around the way, m
  const accuracy::TruthScene scene = accuracy::make_truth_scene();
  const Eigen::Isometry3d& eye = scene.camera.T_world_camera;
  SimulatedNoiseOptions noise;
  noise.seed = draft.random.bits();
  const DepthFrame frame = accuracy::noisy_frame(accuracy::exact_frame(scene), noise);
  const accuracy::Row row = accuracy::make_rows(scene)[2];
  const Vector3d middle = row.paths.front().hip.front();
  for (const Eigen::Vector3f& pixel : accuracy::back_project(frame).positions) {
    const Vector3d point = eye * pixel.cast<double>();
    if ((point - middle).norm() > 2 * kMargin) continue;
    draft.add(kMillimetres * point, (eye.translation() - point).normalized());
  }
  if (seen) draft.viewpoint = kMillimetres * eye.translation();
  draft.truth = [scene](const Vector3d& x) {
    Distance d = accuracy::distance_and_normal(scene, x / kMillimetres);
    d.value *= kMillimetres;
    return d;
  };
  draft.clear += 1;
  for (const accuracy::Path& path : row.paths) {
    draft.hand.start(kMillimetres * path.hip.front());
    for (const Vector3d& hip : path.hip) draft.hand.tick(kMillimetres * hip);
  }
}

}  // namespace

void add_seen_rows(std::vector<Row>& rows) {
  for (const bool seen : {false, true}) {
    const std::string how = seen ? " view" : "";
    for (const bool noisy : {false, true}) {
      const std::string with = (noisy ? " noise 0.3" : "") + how;
      const double noise = noisy ? 0.3 : 0;
      rows.push_back({"partial", "partial sphere" + with,
                      [=](Draft& draft) { draw_partial(draft, SolidKind::ball, seen, noise); }});
      rows.push_back({"partial", "partial box" + with,
                      [=](Draft& draft) { draw_partial(draft, SolidKind::block, seen, noise); }});
    }
    rows.push_back(
        {"partial", "partial table" + how, [=](Draft& draft) { draw_table(draft, seen); }});
  }
}

}  // namespace palpate::any_cloud
