#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

void push_sphere(Draft& draft, double radius) {
  const double deepest = std::min(0.4 * radius, 6.0);
  for (int i = 0; i < 12; ++i) {
    const Vector3d out = draft.direction();
    const Vector3d aside = 0.3 * radius * out.cross(draft.direction());
    push(draft, (radius + 8) * out + aside, (radius - deepest) * out + aside);
  }
}

// Of each hundred given normals some are turned, one is zero and one is not a number.
void draw_flip(Draft& draft, double radius, double turned) {
  draft.sphere(radius);
  draft.give_normals = true;
  for (Vector3d& normal : draft.normals) {
    const double draw = draft.random.uniform();
    if (draft.random.uniform() < turned) normal = -normal;
    if (draw < 0.01) normal.setZero();
    if (draw > 0.99) normal.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  draft.truth = ball(radius);
  push_sphere(draft, radius);
}

// Slides around it.
void draw_small(Draft& draft, double radius, double noise) {
  draft.sphere(radius);
  draft.noise = noise;
  draft.truth = ball(radius);
  const double turn = kSlide * 1e-3 / radius;
  const double start = draft.between(0, 6);
  const auto at = [&](int tick, double away) {
    const double a = tick * turn;
    const double b = start + 0.35 * a;
    return Vector3d((radius + away) *
                    Vector3d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
  };
  constexpr int kTicks = 4000;
  constexpr double kDeep = 1.5;
  draft.hand.start(at(0, 15)).to(at(0, -kDeep), kPush);
  for (int tick = 1; tick < kTicks; ++tick) draft.hand.tick(at(tick, -kDeep));
  draft.hand.to(at(kTicks - 1, 15), kPush);
}

}  // namespace

void add_round_rows(std::vector<Row>& rows) {
  for (const int radii : {2, 3, 5, 10, 20}) {
    for (const int turned : {0, 20, 35, 50}) {
      rows.push_back({"flip", fmt::format("flip {}R {}%", radii, turned),
                      [=](Draft& draft) { draw_flip(draft, radii * kRadius, turned / 100.0); }});
    }
  }
  for (const int radii : {2, 3, 5, 10}) {
    for (const double noise : {0.0, 0.3}) {
      rows.push_back({"small", fmt::format("small {}R noise {:g}", radii, noise),
                      [=](Draft& draft) { draw_small(draft, radii * kRadius, noise); }});
    }
  }
}

}  // namespace palpate::any_cloud
