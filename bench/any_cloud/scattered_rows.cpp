// Rows of points that lie on no surface: volumes, and outliers over a sheet.
#include <algorithm>
#include <limits>

#include "any_cloud/rows.hpp"
#include "any_cloud/ways.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

// Without a truth: only steps, faults and time are told.
void draw_volume(Draft& draft, bool bush) {
  constexpr double kFast = 300;  // spacings a second
  for (int i = 0; i < (bush ? 4000 : 8000); ++i) {
    const Vector3d here = bush ? Vector3d{20 * draft.random.normal(), 20 * draft.random.normal(),
                                          20 * draft.random.normal()}
                               : draft.within({-60, -60, -15}, {60, 60, 15});
    draft.add(here, Vector3d::UnitZ());
  }
  draft.hand.start({0, 0, 100});
  for (int i = 0; i < 30; ++i) {
    draft.hand.to(draft.within(Vector3d::Constant(-50), Vector3d::Constant(50)), kFast);
  }
}

constexpr double kSheet = 80;          // side of the sheet among outliers
constexpr double kOutliersAway = 400;  // outliers lie so far at most
constexpr double kClear = 20;          // of any point: free air

// A sheet has two sides: solid is what is very thin.
Shape make_sheet(Draft& draft) {
  const Vector3d X = kSheet * Vector3d::UnitX();
  const Vector3d Y = kSheet * Vector3d::UnitY();
  draft.sheet(-(X + Y) / 2, X, Y);
  return box(Vector3d::Zero(), {kSheet, kSheet, 0.04});
}

// How far x is from a way between two places.
double way_distance(const Vector3d& x, const Vector3d& from, const Vector3d& to) {
  return rod(from, to, 0)(x).value;
}

bool way_is_clear(const Draft& draft, const Vector3d& from, const Vector3d& to) {
  return std::all_of(draft.points.begin(), draft.points.end(),
                     [&](const Vector3d& point) { return way_distance(point, from, to) > kClear; });
}

// Outliers come alone, in pairs, or in clusters of 3 to 6, none near the sheet.
void draw_outliers(Draft& draft, int least, int most) {
  draft.truth = make_sheet(draft);
  const Vector3d far = Vector3d::Constant(kOutliersAway);
  for (int i = 0; i < 40;) {
    const Vector3d middle = draft.within(-far, far);
    if (draft.truth(middle).value < 3 * kClear) continue;
    const int count = least + static_cast<int>(draft.random.bits() %
                                               static_cast<std::uint64_t>(most - least + 1));
    for (int k = 0; k < count; ++k) {
      draft.add(middle + draft.random.uniform() * draft.direction(), Vector3d::UnitZ());
    }
    ++i;
  }
  for (int i = 0; i < 12;) {
    const Vector3d from = draft.within(-far, far);
    const Vector3d to = draft.within(-far, far);
    if (!way_is_clear(draft, from, to)) continue;
    draft.hand.start(from).to(to, 3 * kReach, Wanted::free);
    ++i;
  }
  zig_zag(draft, 1, 25);
}

}  // namespace

void add_scattered_rows(std::vector<Row>& rows) {
  rows.push_back({"volume", "volume lawn", [](Draft& draft) { draw_volume(draft, false); }});
  rows.push_back({"volume", "volume bush", [](Draft& draft) { draw_volume(draft, true); }});
  rows.push_back({"stray", "stray single", [](Draft& draft) { draw_outliers(draft, 1, 1); }});
  rows.push_back({"stray", "stray pairs", [](Draft& draft) { draw_outliers(draft, 2, 2); }});
  rows.push_back({"stray", "stray clusters", [](Draft& draft) { draw_outliers(draft, 3, 6); }});
}

}  // namespace palpate::any_cloud
