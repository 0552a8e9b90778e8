// Rows of planes: noise, thick layers, changing density, holes, points at one place.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

// Twice `half` to a side.
void make_plane(Draft& draft, double half) {
  draft.sheet({-half, -half, 0}, 2 * half * Vector3d::UnitX(), 2 * half * Vector3d::UnitY());
  draft.truth = half_space(Vector3d::Zero(), Vector3d::UnitZ());
}

void make_noisy_plane(Draft& draft, double half, double sigma, bool seen) {
  draft.noise = sigma;
  draft.clear += sigma;
  make_plane(draft, half);
  if (seen) draft.viewpoint = Vector3d(0, 0, 1000);
}

void draw_noise(Draft& draft, double sigma, bool seen) {
  make_noisy_plane(draft, 60, sigma, seen);
  zig_zag(draft, 3, 30);
}

// Noise that fills a layer many spacings thick, as a ToF camera's near by.
void draw_thick(Draft& draft, double sigma, bool seen) {
  make_noisy_plane(draft, 60 + 5 * sigma, sigma, seen);
  draft.deep = sigma / 2;
  zig_zag(draft, sigma, 30);
}

// From spacing 1 to a coarser one and back.
void draw_density(Draft& draft, double step) {
  const Vector3d Y = 80 * Vector3d::UnitY();
  const double far = std::max(8 * step, 40.0);
  draft.sheet({-40, -40, 0}, 40 * Vector3d::UnitX(), Y);
  draft.sheet({step, -40, 0}, far * Vector3d::UnitX(), Y, step);
  draft.truth = half_space(Vector3d::Zero(), Vector3d::UnitZ());
  for (int i = 0; i < 4; ++i) {
    const double y = draft.between(-20, 20);
    draft.hand.start({-20, y, 15}).to({-20, y, -2}, kPush).to({0.6 * far, y, -2}, kSlide);
    draft.hand.to({-20, y, -2}, kSlide).to({-20, y, 15}, kPush);
  }
}

// Small holes are closed; what wider ones do is their own affair.
void draw_hole(Draft& draft, double wide) {
  make_plane(draft, 40);
  std::erase_if(draft.points, [&](const Vector3d& point) { return point.norm() < wide / 2; });
  draft.normals.resize(draft.points.size());
  const double rim = wide / 2 + 3;
  const Wanted wanted = wide <= 3 ? Wanted::judged : Wanted::ignored;
  for (int i = 0; i < 8; ++i) {
    const Eigen::AngleAxisd turn(draft.between(0, 2 * std::numbers::pi), Vector3d::UnitZ());
    const double y = draft.between(-wide / 2, wide / 2);
    const auto at = [&](double x, double z) { return Vector3d(turn * Vector3d(x, y, z)); };
    draft.hand.start(at(-20, 15)).to(at(-20, -1), kPush).to(at(-rim, -1), kSlide);
    draft.hand.to(at(rim, -1), kSlide, wanted).to(at(20, -1), kSlide, wanted);
    draft.hand.to(at(20, 15), kPush, wanted);
  }
}

void draw_copies(Draft& draft, double share, int copies, double apart) {
  make_plane(draft, 40);
  const std::size_t count = draft.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (draft.random.uniform() >= share) continue;
    for (int k = 1; k < copies; ++k) {
      draft.add(draft.points[i] + apart * draft.direction(), draft.normals[i]);
    }
  }
  zig_zag(draft, 2, 20);
}

}  // namespace

void add_flat_rows(std::vector<Row>& rows) {
  for (const double sigma : {0.0, 0.5, 1.0, 1.5, 2.0}) {
    for (const bool seen : {false, true}) {
      rows.push_back({"noise", fmt::format("noise {:g}{}", sigma, seen ? " view" : ""),
                      [=](Draft& draft) { draw_noise(draft, sigma, seen); }});
    }
  }
  for (const double sigma : {3.0, 4.0, 6.0, 8.0}) {
    for (const bool seen : {false, true}) {
      rows.push_back({"thick", fmt::format("thick noise {:g}{}", sigma, seen ? " view" : ""),
                      [=](Draft& draft) { draw_thick(draft, sigma, seen); }});
    }
  }
  for (const int step : {2, 4, 10}) {
    rows.push_back({"density", fmt::format("density 1:{}", step),
                    [=](Draft& draft) { draw_density(draft, step); }});
  }
  for (const int wide : {2, 3, 4, 6, 10}) {
    rows.push_back(
        {"hole", fmt::format("hole {}", wide), [=](Draft& draft) { draw_hole(draft, wide); }});
  }
  rows.push_back(
      {"duplicate", "duplicate triple", [](Draft& draft) { draw_copies(draft, 1, 3, 0); }});
  rows.push_back(
      {"duplicate", "duplicate clusters", [](Draft& draft) { draw_copies(draft, 0.05, 10, 0.1); }});
}

}  // namespace palpate::any_cloud
