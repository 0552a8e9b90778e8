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

// Two sheets that meet at x = z = 0 and open towards x; the hand comes from between them.
void draw_wedge(Draft& draft, double degrees, bool signs) {
  const double half = radians(degrees) / 2;
  const Vector3d Y = 50 * Vector3d::UnitY();
  const Vector3d upper(50 * std::cos(half), 0, 50 * std::sin(half));
  const Vector3d lower(upper.x(), 0, -upper.z());
  draft.sheet(-Y / 2, Y, upper);
  draft.sheet(-Y / 2, lower, Y);
  draft.give_normals = signs;
  draft.truth = unite(half_space(Vector3d::Zero(), Y.cross(upper)),
                      half_space(Vector3d::Zero(), lower.cross(Y)));
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

}  // namespace

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
}

}  // namespace palpate::any_cloud
