// Rows of thin plates, their rims, and the gap between two sheets.
#include <fmt/format.h>

#include <cmath>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kSide = 60;  // of a plate

enum class Known { nothing, normals, viewpoint };

// Its top is z = 0. Faces thicker than a spacing have rows of points between the rims.
void make_plate(Draft& draft, double thick) {
  const Vector3d X = kSide * Vector3d::UnitX();
  const Vector3d Y = kSide * Vector3d::UnitY();
  const Vector3d corner = -(X + Y) / 2;
  const Vector3d down(0, 0, -thick);
  draft.sheet(corner, X, Y);
  draft.sheet(corner + down, Y, X);
  const int rows = static_cast<int>(std::lround(thick));
  for (int i = 1; i < rows; ++i) {
    const auto row = [&](const Vector3d& from, const Vector3d& along) {
      const Vector3d out = along.cross(Vector3d::UnitZ()).normalized();
      for (int k = 0; k < kSide; ++k) {
        const double u = (k + draft.between(-draft.jitter, draft.jitter)) / kSide;
        const double v = (i + draft.between(-draft.jitter, draft.jitter)) / rows;
        draft.add(from + u * along + v * down, out);
      }
    };
    row(corner, X);
    row(corner + X, Y);
    row(corner + X + Y, -X);
    row(corner + Y, -Y);
  }
  draft.truth = box(down / 2, {kSide, kSide, thick});
}

void draw_plate(Draft& draft, double thick, double jitter, Known known) {
  draft.jitter = jitter;
  make_plate(draft, thick);
  draft.give_normals = known == Known::normals;
  if (known == Known::viewpoint) draft.viewpoint = Vector3d(0, 0, 1000);
  zig_zag(draft, 1, 16);
}

// Over the edge, and along the other face.
void draw_rim(Draft& draft, double thick) {
  make_plate(draft, thick);
  constexpr double kDeep = 1;  // spacings
  const double below = -thick - 5;
  for (int i = 0; i < 3; ++i) {
    const double y = draft.between(-20, 20);
    draft.hand.start({10, y, 10}).to({10, y, -kDeep}, kPush).to({29, y, -kDeep}, kSlide);
    draft.hand.to({34, y, -kDeep}, kSlide, Wanted::either).to({34, y, below}, kSlide);
    draft.hand.to({10, y, below}, kReach);
    draft.hand.to({10, y, kDeep - thick}, kPush).to({-10, y, kDeep - thick}, kSlide);
    draft.hand.to({-10, y, below}, kPush);
  }
}

// Both sheets are touched from between.
void draw_gap(Draft& draft, double wide) {
  const Vector3d corner(-40, -40, 0);
  const Vector3d X = 80 * Vector3d::UnitX();
  const Vector3d Y = 80 * Vector3d::UnitY();
  const Vector3d up(0, 0, wide);
  draft.sheet(corner, X, Y);
  draft.sheet(corner + up, Y, X);
  draft.truth = unite(half_space(Vector3d::Zero(), up), half_space(up, -up));
  for (int i = 0; i < 3; ++i) {
    const Vector3d at = draft.within({-10, -20, wide / 2}, {0, 20, wide / 2});
    const Vector3d on = at + draft.within({15, -10, 0}, {20, 10, 0});
    const Vector3d half = up / 2 + Vector3d(0, 0, 2);
    draft.hand.start({-60, at.y(), wide / 2}).to(at, kReach, Wanted::ignored);
    draft.hand.to(at - half, kPush).to(on - half, kSlide).to(on + half, kPush);
    draft.hand.to(at + half, kSlide).to(at, kPush);
  }
}

}  // namespace

void add_thin_rows(std::vector<Row>& rows) {
  for (const double thick : {0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 12.0}) {
    const auto add = [&](const char* how, double jitter, Known known) {
      rows.push_back({"plate", fmt::format("plate {:g} {}", thick, how),
                      [=](Draft& draft) { draw_plate(draft, thick, jitter, known); }});
    };
    add("grid", 0, Known::nothing);
    add("jitter", 0.2, Known::nothing);
    add("jitter normals", 0.2, Known::normals);
    add("jitter view", 0.2, Known::viewpoint);
  }
  for (const double thick : {1.0, 2.0, 3.0, 5.0, 8.0}) {
    rows.push_back(
        {"rim", fmt::format("rim {:g}", thick), [=](Draft& draft) { draw_rim(draft, thick); }});
  }
  for (const double wide : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 8.0, 10.0}) {
    rows.push_back(
        {"gap", fmt::format("gap {:g}", wide), [=](Draft& draft) { draw_gap(draft, wide); }});
  }
}

}  // namespace palpate::any_cloud
