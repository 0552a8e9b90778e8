// Rows of badly sampled bodies: scanned twice, in slices, rounded, of uneven density, with
// outliers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "any_cloud/bodies.hpp"
#include "any_cloud/rows.hpp"
#include "any_cloud/spaced_points.hpp"
#include "any_cloud/tour.hpp"
#include "base/numbers.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

Shape moved(const Shape& shape, const Eigen::Isometry3d& T) {
  return [shape, T, back = T.inverse()](const Vector3d& x) {
    Distance d = shape(back * x);
    d.gradient = T.linear() * d.gradient;
    return d;
  };
}

// Takes a scan for `draft.points` while the hand knows the whole surface of `draft.truth`.
using Sample = std::function<void(Draft& draft, const Body& body)>;

void touch_sampled(Draft& draft, const Sample& sample) {
  const Body body = draw_body(draft);
  scan(draft, body);
  sample(draft, body);
}

// A second scan of the same, `apart` off in some direction and turned by up to 2 degrees.
void scan_twice(Draft& draft, const Body& body, double apart) {
  const Vector3d axis = draft.direction();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(apart * draft.direction());
  T.rotate(Eigen::AngleAxisd(draft.between(0, 2) * kDegree, axis));
  const Shape second = moved(body.shape, T);
  draft.truth = unite(body.shape, second);
  draft.surface(second, -body.reach - Vector3d::Constant(apart + 1),
                body.reach + Vector3d::Constant(apart + 1));
  poke_around(draft);
}

// The place near p on the surface and in the plane; false where there is none.
bool into_plane(const Shape& shape, const Vector3d& normal, double height, Vector3d& p) {
  for (int i = 0; i < 30; ++i) {
    p += (height - normal.dot(p)) * normal;
    const Distance d = shape(p);
    if (std::abs(d.value) < 1e-3) return true;
    const Vector3d along = d.gradient - normal.dot(d.gradient) * normal;
    if (along.squaredNorm() < 0.05) return false;
    p -= d.value / along.squaredNorm() * along;
  }
  return false;
}

constexpr double kPitch = 2;  // of slices

// Is the way to the nearest of `points` no longer than three quarters of the pitch?
bool is_sampled(const Vector3d& place, const std::vector<Vector3d>& points) {
  constexpr double kNear = 0.75 * kPitch;
  return std::any_of(points.begin(), points.end(), [&](const Vector3d& point) {
    return (point - place).squaredNorm() <= kNear * kNear;
  });
}

// Slices in any direction, whose points are `ratio` times as near each other as the slices are.
// Hands poke where slices are: a face that lies along them is between two.
void slice(Draft& draft, const Body& body, double ratio) {
  const Vector3d normal = draft.direction();
  const double first = draft.between(0, kPitch);
  std::vector<Vector3d> sliced;
  SpacedPoints taken;
  for (const Vector3d& seed : draft.points) {
    const double height = first + kPitch * std::round((normal.dot(seed) - first) / kPitch);
    for (int i = 0; i < 4 * ratio; ++i) {
      const double off = draft.random.uniform();
      Vector3d p = seed + off * draft.direction();
      if (!into_plane(body.shape, normal, height, p)) continue;
      if (taken.add(ratio / kPitch * p)) sliced.push_back(p);
    }
  }
  std::vector<Vector3d> targets;
  std::vector<Vector3d> outward;
  for (std::size_t i = 0; i < draft.points.size(); ++i) {
    if (!is_sampled(draft.points[i], sliced)) continue;
    targets.push_back(draft.points[i]);
    outward.push_back(draft.normals[i]);
  }
  draft.points = std::move(targets);
  draft.normals = std::move(outward);
  poke_around(draft);
  draft.points.clear();
  draft.normals.clear();
  for (const Vector3d& p : sliced) draft.add(p, body.shape(p).gradient.normalized());
}

void outlier(Draft& draft, const Body& body, double share) {
  poke_around(draft);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(draft.points.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d p = draft.within(-1.5 * body.reach, 1.5 * body.reach);
    draft.add(p, draft.direction());
  }
}

void round_to(Draft& draft, double step) {
  poke_around(draft);
  for (Vector3d& p : draft.points) p = step * (p / step).array().round().matrix();
}

// Up to `most` times as many points in some places as in others.
void thin_out(Draft& draft, double most) {
  poke_around(draft);
  const double length = draft.between(20, 40);
  const Vector3d wave = draft.direction() * (2 * std::numbers::pi / length);
  const std::vector<Vector3d> all = std::move(draft.points);
  const std::vector<Vector3d> normals = std::move(draft.normals);
  draft.points.clear();
  draft.normals.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double share = 0.5 + 0.5 * std::sin(wave.dot(all[i]));
    if (draft.random.uniform() < std::pow(most, -share)) draft.add(all[i], normals[i]);
  }
}

}  // namespace

void add_sampled_rows(std::vector<Row>& rows) {
  const auto add = [&](const std::string& name, const Sample& sample) {
    rows.push_back({"sampled", name, [=](Draft& draft) { touch_sampled(draft, sample); }});
  };
  for (const double apart : {0.5, 1.0, 2.0, 3.0, 5.0}) {
    add(fmt::format("double {}", apart),
        [=](Draft& draft, const Body& body) { scan_twice(draft, body, apart); });
  }
  for (const int ratio : {2, 4, 6, 10}) {
    add(fmt::format("slices {}:1", ratio),
        [=](Draft& draft, const Body& body) { slice(draft, body, ratio); });
  }
  for (const int percent : {1, 5, 15, 30}) {
    add(fmt::format("outliers {} %", percent),
        [=](Draft& draft, const Body& body) { outlier(draft, body, 0.01 * percent); });
  }
  add("rounded 0.5", [](Draft& draft, const Body&) { round_to(draft, 0.5); });
  add("density 1:20 patches", [](Draft& draft, const Body&) { thin_out(draft, 20); });
}

}  // namespace palpate::any_cloud
