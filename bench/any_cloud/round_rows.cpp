// Rows of round bodies: spheres with faulty normals, small spheres, rods, needles and posts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

// Gives normals: some are turned, one in a hundred is zero and one in a hundred is NaN.
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
  constexpr double kDeep = 1.5;  // spacings
  draft.hand.start(at(0, 15)).to(at(0, -kDeep), kPush);
  for (int tick = 1; tick < kTicks; ++tick) draft.hand.tick(at(tick, -kDeep));
  draft.hand.to(at(kTicks - 1, 15), kPush);
}

// Pushes on its side and a slide along it.
void draw_rod(Draft& draft, double radius) {
  const Vector3d end(30, 0, 0);
  draft.truth = rod(-end, end, radius);
  const Vector3d reach = Vector3d::Constant(radius + 1) + end;
  draft.surface(draft.truth, -reach, reach);
  const double depth = std::min(0.8 * radius, 3.0);
  draft.deep = std::min(draft.deep, 0.5 * depth);
  for (int i = 0; i < 12; ++i) {
    const double angle = draft.between(0, 2 * std::numbers::pi);
    const Vector3d out(0, std::cos(angle), std::sin(angle));
    const Vector3d at = Vector3d(draft.between(-20, 20), 0, 0) +
                        draft.between(-0.3, 0.3) * radius * out.cross(Vector3d::UnitX());
    const Vector3d deepest = at + (radius - depth) * out;
    const Vector3d along(at.x() > 0 ? -15 : 15, 0, 0);
    draft.hand.start(at + (radius + 10) * out).to(deepest, kPush).to(deepest + along, kSlide);
    draft.hand.to(deepest + along + 10 * out, kPush);
  }
}

// A line of points. Nobody knows how thick it is, so contact is never required.
void draw_needle(Draft& draft) {
  const Vector3d end(30, 0, 0);
  for (int i = -30; i <= 30; ++i) {
    draft.add({i + draft.between(-0.2, 0.2), 0, 0}, Vector3d::UnitZ());
  }
  draft.truth = rod(-end, end, 0.05);
  draft.deep = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 12; ++i) {
    const double angle = draft.between(0, 2 * std::numbers::pi);
    const Vector3d out(0, std::cos(angle), std::sin(angle));
    const Vector3d at = Vector3d(draft.between(-20, 20), 0, 0) +
                        draft.between(-1.5, 1.5) * out.cross(Vector3d::UnitX());
    draft.hand.start(at + 12 * out).to(at - 12 * out, kPush);
  }
}

// A post with a panel that is one sheet.
void draw_post(Draft& draft) {
  constexpr double kPost = 4;  // radius, spacings
  const Vector3d end(0, 0, 30);
  draft.truth = rod(-end, end, kPost);
  draft.surface(draft.truth, {-5, -5, -35}, {5, 5, 35});
  draft.sheet({kPost, 0, -20}, 30 * Vector3d::UnitX(), 40 * Vector3d::UnitZ());
  draft.truth = unite(draft.truth, box({kPost + 15, 0, 0}, {30, 0.04, 40}));
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    const Vector3d on = draft.within({10, -2 * side, -14}, {28, -2 * side, 14});
    const Vector3d corner(3, -side, on.z());
    draft.hand.start(on + Vector3d(0, 12 * side, 0)).to(on, kPush).to(corner, kSlide);
    draft.hand.to({10, 10 * side, on.z()}, kPush);
    const double angle = draft.between(0.6, 1.4) * std::numbers::pi;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const Vector3d height(0, 0, draft.between(-20, 20));
    push(draft, height + (kPost + 10) * out, height + (kPost - 2) * out);
  }
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
  for (const double radii : {0.3, 0.6, 1.0, 2.0, 4.0}) {
    rows.push_back({"rod", fmt::format("rod {:g}R", radii),
                    [=](Draft& draft) { draw_rod(draft, radii * kRadius); }});
  }
  rows.push_back({"wire", "wire needle", draw_needle});
  rows.push_back({"post", "post with panel", draw_post});
}

}  // namespace palpate::any_cloud
