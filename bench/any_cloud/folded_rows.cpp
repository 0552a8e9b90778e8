// Rows of wedges, ridges, boxes and corners, where two or three faces meet.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

// The hand comes from between the sheets.
void draw_wedge(Draft& draft, double degrees, bool signs) {
  make_fold(draft, degrees);
  draft.give_normals = signs;
  for (int i = 0; i < 12; ++i) {
    const Vector3d at = draft.within({-10, -15, -3}, {-6, 15, 3});
    draft.hand.start({40, at.y(), at.z()}).to({5, at.y(), at.z()}, kPush);
    draft.hand.to(at, kPush).to({5, at.y(), at.z()}, kPush).to({40, at.y(), at.z()}, kReach);
  }
}

// A roof with its ridge along y, at x = z = 0.
struct Roof {
  double half;  // angle between either side and the vertical

  // On a side (-1 or 1), so far down from the ridge and so deep.
  [[nodiscard]] Vector3d at(int side, double y, double down, double deep) const {
    return {side * (down * std::sin(half) - deep * std::cos(half)), y,
            -down * std::cos(half) - deep * std::sin(half)};
  }
};

void slide_over(Draft& draft, const Roof& roof, int side, double y) {
  draft.hand.start(roof.at(side, y, 10, -10)).to(roof.at(side, y, 10, 1), kPush);
  draft.hand.to(roof.at(side, y, 1.5 + 1 / std::tan(roof.half), 1), kSlide);
  draft.hand.to(roof.at(side, y, -7, 1), kSlide, Wanted::either);
}

void draw_ridge(Draft& draft, double degrees, bool signs) {
  const Roof roof{radians(degrees) / 2};
  const double wide = 15;
  const double high = wide / std::tan(roof.half);
  const Vector3d Y = 40 * Vector3d::UnitY();
  const Vector3d left(-wide, 0, -high);
  const Vector3d right(wide, 0, -high);
  draft.sheet(-Y / 2, Y, left);
  draft.sheet(-Y / 2, right, Y);
  draft.sheet(left - Y / 2, Y, right - left);
  draft.give_normals = signs;
  draft.truth = extruded({Vector2d(0, 0), Vector2d(-wide, -high), Vector2d(wide, -high)});
  for (int i = 0; i < 3; ++i) {
    for (const int side : {-1, 1}) {
      slide_over(draft, roof, side, draft.between(-10, 10));
      const Vector3d onto = roof.at(side, draft.between(-10, 10), draft.between(1, 3), 1.2);
      push(draft, {onto.x(), onto.y(), 10}, onto);
    }
  }
}

const Vector3d kBox(30, 30, 20);

void make_box(Draft& draft, double noise, bool signs) {
  draft.truth = box(Vector3d::Zero(), kBox);
  draft.surface(draft.truth, -kBox / 2 - Vector3d::Ones(), kBox / 2 + Vector3d::Ones());
  draft.noise = noise;
  draft.give_normals = signs;
}

// Over an edge, along the next face, and pushes on the edge.
void draw_box(Draft& draft, double noise, bool signs) {
  make_box(draft, noise, signs);
  for (int i = 0; i < 4; ++i) {
    const double y = draft.between(-10, 10);
    draft.hand.start({5, y, 20}).to({5, y, 9}, kPush).to({13.5, y, 9}, kSlide);
    draft.hand.to({17, y, 9}, kSlide, Wanted::either).to({17, y, 5}, kSlide, Wanted::either);
    draft.hand.to({14, y, 5}, kPush).to({14, y, -5}, kSlide).to({25, y, -5}, kPush);
    const Vector3d edge(15 + draft.between(-0.7, 0.7), y, 10);
    push(draft, edge + Vector3d(6, 0, 6), edge - Vector3d(1.5, 0, 1.5));
  }
}

// Pushes on a corner and slides over it.
void draw_corners(Draft& draft, double noise, bool signs) {
  make_box(draft, noise, signs);
  for (int i = 0; i < 4; ++i) {
    const Vector3d corner = kBox / 2 + draft.within({-0.7, -0.7, 0}, {0.7, 0.7, 0});
    push(draft, corner + 5 * Vector3d::Ones(), corner - 1.5 * Vector3d::Ones());
    const Vector3d way(draft.between(0.5, 1), draft.between(0.5, 1), 0);
    const Vector3d on = kBox / 2 - Vector3d::UnitZ();
    draft.hand.start(on - 10 * way + Vector3d(0, 0, 10)).to(on - 10 * way, kPush);
    draft.hand.to(on - 2 * way, kSlide).to(on + 3 * way, kSlide, Wanted::either);
  }
}

// A wall that is one sheet stands on a floor; the hand comes from either side.
void draw_tee(Draft& draft) {
  constexpr double kHigh = 25;  // spacings
  const Vector3d Y = 50 * Vector3d::UnitY();
  draft.sheet({-25, -25, 0}, 50 * Vector3d::UnitX(), Y);
  draft.sheet({0, -25, 1}, Y, (kHigh - 1) * Vector3d::UnitZ());
  draft.truth = unite(half_space(Vector3d::Zero(), Vector3d::UnitZ()),
                      box({0, 0, kHigh / 2}, {0.04, 200, kHigh}));
  for (int i = 0; i < 6; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    const double y = draft.between(-12, 12);
    draft.hand.start({15 * side, y, 20}).to({15 * side, y, -1}, kPush);
    draft.hand.to({-side, y, -1}, kSlide).to({-side, y, 15}, kSlide).to({15 * side, y, 15}, kPush);
  }
}

}  // namespace

void make_fold(Draft& draft, double degrees) {
  const double half = radians(degrees) / 2;
  const Vector3d Y = 50 * Vector3d::UnitY();
  const Vector3d upper(50 * std::cos(half), 0, 50 * std::sin(half));
  const Vector3d lower(upper.x(), 0, -upper.z());
  draft.sheet(-Y / 2, Y, upper);
  draft.sheet(-Y / 2, lower, Y);
  draft.truth = unite(half_space(Vector3d::Zero(), Y.cross(upper)),
                      half_space(Vector3d::Zero(), lower.cross(Y)));
}

void add_folded_rows(std::vector<Row>& rows) {
  for (const bool signs : {false, true}) {
    const char* how = signs ? " signs" : "";
    for (int degrees = 20; degrees <= 130; degrees += 10) {
      rows.push_back({"wedge", fmt::format("wedge {}{}", degrees, how),
                      [=](Draft& draft) { draw_wedge(draft, degrees, signs); }});
    }
    for (const int degrees : {40, 50, 60, 70, 90, 110, 130, 150}) {
      rows.push_back({"ridge", fmt::format("ridge {}{}", degrees, how),
                      [=](Draft& draft) { draw_ridge(draft, degrees, signs); }});
    }
  }
  for (const double noise : {0.0, 0.25}) {
    for (const bool signs : {false, true}) {
      const std::string how = fmt::format("noise {:g}{}", noise, signs ? " signs" : "");
      rows.push_back({"box", "box " + how, [=](Draft& draft) { draw_box(draft, noise, signs); }});
      rows.push_back(
          {"corners", "corners " + how, [=](Draft& draft) { draw_corners(draft, noise, signs); }});
    }
  }
  rows.push_back({"tee", "tee", draw_tee});
}

}  // namespace palpate::any_cloud
