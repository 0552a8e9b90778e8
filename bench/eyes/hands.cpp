// Draws the paths of hands that slide, poke, come from the side and reach behind.
#include <algorithm>
#include <cmath>
#include <limits>

#include "eyes/view.hpp"

namespace palpate::eyes {
namespace {

constexpr double kPress = 0.003;    // m; judgement: the depth of slides in the other benches
constexpr double kBefore = 0.03;    // m; judgement: a hand that is free of all noise
constexpr double kDeepest = 0.012;  // m; judgement: what runs deeper into walls tells nothing
constexpr int kTries = 200;         // judgement

/// A seen place, what is its normal, and the direction to the camera.
struct Place {
  Vector3d at = Vector3d::Zero();
  Vector3d normal = Vector3d::Zero();
  Vector3d to_eye = Vector3d::Zero();
};

double clearance(const View& view, const Vector3d& x) {
  return distance_and_normal(view.scene, x, 0).value;
}

/// Is the way farther than `least` (m) from all solids?
bool is_clear(const View& view, const Vector3d& from, const Vector3d& to, double least) {
  constexpr int kPlaces = 60;
  for (int k = 0; k <= kPlaces; ++k) {
    if (clearance(view, from + (k * 1.0 / kPlaces) * (to - from)) < least) return false;
  }
  return true;
}

/// A pixel within 15 cm of the middle; seen at 80 degrees at most, on or near what stands there.
bool draw_place(View& view, const Picture& picture, double lowest, Place& place) {
  constexpr double kAround = 0.15;
  const int width = picture.camera.width;
  const int height = picture.camera.height;
  for (int k = 0; k < kTries; ++k) {
    const int u = static_cast<int>(view.between(0.1, 0.9) * width);
    const int v = static_cast<int>(view.between(0.1, 0.9) * height);
    const Vector3d at = picture.point(u, v);
    if (!(picture.depth[static_cast<std::size_t>(v * width + u)] > 0)) continue;
    if (std::hypot(at.x(), at.y()) > kAround || at.z() < lowest) continue;
    place.at = at;
    place.normal = distance_and_normal(view.scene, at, 0).gradient;
    place.to_eye = (picture.T_camera_world.inverse().translation() - at).normalized();
    if (place.normal.dot(place.to_eye) > std::cos(80 * kDegree)) return true;
  }
  return false;
}

Vector3d across(View& view, const Vector3d& normal) {
  const Vector3d side = normal.unitOrthogonal();
  return Eigen::AngleAxisd(view.between(0, 2 * std::numbers::pi), normal) * side;
}

/// Back to free air before the camera, and to and fro there.
void leave(View& view, const Place& place, const Vector3d& from) {
  view.go(from + 0.05 * place.to_eye, 0.15);
  view.hold(0.1);
  view.go(from + 0.05 * place.to_eye + 0.03 * across(view, place.to_eye), 0.15);
  view.hold(0.15);
}

/// The place on the way from `begin` where the hand is deep in a solid, or its end.
Vector3d shallow_end(const View& view, const Vector3d& begin, const Vector3d& way) {
  constexpr int kPlaces = 100;
  for (int k = 1; k <= kPlaces; ++k) {
    const Vector3d x = begin + k * 1.0 / kPlaces * way;
    if (clearance(view, x) < -kDeepest) return begin + (k - 1) * 1.0 / kPlaces * way;
  }
  return begin + way;
}

std::vector<Vector3d> slide(View& view, const Place& place) {
  const Vector3d along = across(view, place.normal);
  const double length = view.between(0.05, 0.1);
  const Vector3d begin = place.at - kPress * place.normal;
  view.hip = {place.at + 0.015 * place.normal};
  view.go(begin, 0.05);
  view.hold(0.1);
  const Vector3d end = shallow_end(view, begin, length * along);
  view.go(end, view.between(0.04, 0.12));
  view.hold(0.05);
  leave(view, place, end);
  return std::move(view.hip);
}

std::vector<Vector3d> poke(View& view, const Place& place) {
  const Vector3d way =
      Eigen::AngleAxisd(view.between(0, 45) * kDegree, across(view, place.normal)) * place.normal;
  const double deep = view.between(0.003, 0.008);
  view.hip = {place.at + 0.03 * way};
  view.go(place.at - deep * way, view.between(0.04, 0.15));
  view.hold(0.1);
  leave(view, place, place.at);
  return std::move(view.hip);
}

std::vector<Vector3d> aside(View& view, const Place& place) {
  const Vector3d way = across(view, place.to_eye);
  const Vector3d middle = place.at - view.between(0, 0.006) * place.to_eye;
  const Vector3d from = middle - 0.06 * way;
  if (clearance(view, from) < 0.004) return {};
  view.hip = {from};
  const Vector3d end = shallow_end(view, from, 0.12 * way);
  view.go(end, view.between(0.05, 0.2));
  view.hold(0.05);
  leave(view, place, end);
  return std::move(view.hip);
}

/// Goes around a thing into its shadow, presses it towards the camera from there, and comes back.
std::vector<Vector3d> behind(View& view, const Picture& picture, const Place& place) {
  Vector3d back = place.at - 0.002 * place.to_eye;
  while (clearance(view, back) < 0.001 && (back - place.at).norm() < 0.2) {
    back -= 0.001 * place.to_eye;
  }
  const Vector3d goal = back - view.between(0.012, 0.03) * place.to_eye;
  if (clearance(view, goal) < 0.01) return {};
  const double deep = std::min(0.004, 0.4 * (back - place.at).norm());
  const Vector3d side = across(view, place.to_eye);
  for (double out = 0.02; out < 0.25; out += 0.01) {
    const Vector3d beside = goal + out * side;
    const double seen = picture.depth_at(beside, 8);
    if (!(seen > picture.depth_of(beside) + 0.01)) continue;
    if (!is_clear(view, beside, goal, 0.006)) return {};
    view.hip = {beside};
    view.hold(0.05);
    view.go(goal, 0.15);
    view.go(back + deep * place.to_eye, 0.06);
    view.hold(0.15);
    view.go(goal, 0.1);
    view.go(beside, 0.15);
    view.hold(0.1);
    return std::move(view.hip);
  }
  return {};
}

/// Goes through a gap, up to 45 degrees aside of a camera's ray, waits behind it and in it, and
/// comes back.
std::vector<Vector3d> through(View& view, const Vector3d& eye) {
  constexpr double kPart = 0.8;  // of half the gap stays free around the hand (judgement)
  constexpr double kFar = 0.05;  // m before and behind it, at most (judgement)
  const Vector3d at = view.gaps[view.random.bits() % view.gaps.size()];
  const Vector3d ray = (eye - at).normalized();
  const Vector3d way = Eigen::AngleAxisd(view.between(0, 45) * kDegree, across(view, ray)) * ray;
  const double clearance = kPart * view.gap / 2;
  const double deep = std::min(kFar, view.behind - clearance);
  if (deep < 0 || !is_clear(view, at + kFar * way, at - deep * way, clearance)) return {};
  view.hip = {at + kFar * way};
  view.hold(0.05);
  view.go(at - deep * way, view.between(0.05, 0.2));
  view.hold(0.1);
  view.go(at, 0.1);
  view.hold(0.2);
  view.go(at + kFar * way, 0.1);
  view.hold(0.1);
  return std::move(view.hip);
}

}  // namespace

Picture::Picture(const View& view, const SimulatedCameraOptions& of)
    : camera(of.camera), T_camera_world(of.T_world_camera.inverse()) {
  DepthRenderer(camera).render(solids_at(view.scene, 0), of.T_world_camera, depth);
}

double Picture::depth_at(const Vector3d& x, int around) const {
  const Vector3d seen = T_camera_world * x;
  if (!(seen.z() > 0.05)) return 0;
  const Pinhole& p = camera.pinhole;
  const auto u = static_cast<int>(std::lround(p.cx + p.fx * seen.x() / seen.z()));
  const auto v = static_cast<int>(std::lround(p.cy + p.fy * seen.y() / seen.z()));
  if (u < around || v < around || u + around >= camera.width || v + around >= camera.height) {
    return 0;
  }
  float least = std::numeric_limits<float>::infinity();
  for (int y = v - around; y <= v + around; ++y) {
    for (int w = u - around; w <= u + around; ++w) {
      const float z = depth[static_cast<std::size_t>(y) * camera.width + w];
      if (z > 0) least = std::min(least, z);
    }
  }
  return std::isfinite(least) ? least : 0;
}

Vector3d Picture::point(int u, int v) const {
  const Pinhole& p = camera.pinhole;
  const double z = depth[static_cast<std::size_t>(v) * camera.width + u];
  return T_camera_world.inverse() * Vector3d(z * (u - p.cx) / p.fx, z * (v - p.cy) / p.fy, z);
}

Hand draw_hand(View& view, const Picture& picture, const std::string& kind) {
  // What is behind things to one camera another one sees.
  Hand hand{kind, {}, kind == "behind" && view.cameras.size() == 1};
  if (kind == "through") {
    hand.free = true;
    const Vector3d eye = view.cameras.front().T_world_camera.translation();
    for (int k = 0; k < 20 && hand.hip.empty(); ++k) hand.hip = through(view, eye);
    return hand;
  }
  Place place;
  // Half of them meet what stands on the floor.
  const double lowest = kind == "behind" || view.random.uniform() < 0.5 ? 0.002 : -1;
  for (int k = 0; k < 20 && hand.hip.empty(); ++k) {
    if (!draw_place(view, picture, lowest, place)) return hand;
    if (clearance(view, place.at + kBefore * place.normal) < 0.004) continue;
    hand.hip = kind == "slide"   ? slide(view, place)
               : kind == "poke"  ? poke(view, place)
               : kind == "aside" ? aside(view, place)
                                 : behind(view, picture, place);
  }
  return hand;
}

}  // namespace palpate::eyes
