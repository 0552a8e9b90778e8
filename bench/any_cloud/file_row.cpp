// The row of a cloud from a file: ways through free air, and presses on the points.
#include "any_cloud/file_row.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "any_cloud/ways.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/spacing.hpp"
#include "palpate/io/files.hpp"

namespace palpate::any_cloud {
namespace {

using Eigen::Vector3d;

constexpr double kSpacings = 3;    // of the nearest point: free air is farther from it
constexpr double kFarther = 0.02;  // and than this, m
constexpr int kPresses = 100;
constexpr int kFileTries = 1000;  // for a place in free air

// The file's cloud in its median spacing, and where air is free in it.
class FreeAir {
 public:
  explicit FreeAir(const PointCloud& cloud)
      : grid_(cloud.positions), spacings_(local_spacings(grid_)), spacing_(median(spacings_)) {}

  [[nodiscard]] double spacing() const { return spacing_; }

  // `x` in spacings.
  [[nodiscard]] bool holds(const Vector3d& x) const {
    std::vector<CellGrid::Neighbor> nearest;
    grid_.nearest((x * spacing_).cast<float>(), 1, nearest);
    const double away = std::sqrt(nearest.front().squared_distance);
    return away > std::max(kFarther, kSpacings * spacings_[nearest.front().index]);
  }

 private:
  CellGrid grid_;
  std::vector<float> spacings_;
  double spacing_;
};

// Straight and as long as air is free, 150 ticks at most.
void add_way(Draft& draft, const FreeAir& air, const Eigen::AlignedBox3d& box) {
  constexpr int kTicks = 150;
  constexpr double kStep = 1.5;  // spacings a tick
  for (int i = 0; i < kFileTries; ++i) {
    Vector3d place = draft.within(box.min(), box.max());
    if (!air.holds(place)) continue;
    const Vector3d step = kStep * draft.direction();
    draft.hand.start(place);
    for (int k = 0; k < kTicks && air.holds(place += step); ++k) {
      draft.hand.tick(place, Wanted::free);
    }
    return;
  }
}

// On a point of the cloud, from a place in free air near it, 3 spacings deep.
void add_press(Draft& draft, const FreeAir& air) {
  constexpr double kFirst = 10;  // spacings
  constexpr double kDeep = 3;    // spacings
  for (int i = 0; i < kFileTries; ++i) {
    const Vector3d& point = draft.points[draft.random.bits() % draft.points.size()];
    const Vector3d out = draft.direction();
    double away = kFirst;
    while (away < 8 * kFirst && !air.holds(point + away * out)) away *= 2;
    if (!air.holds(point + away * out)) continue;
    draft.hand.start(point + away * out).to(point - kDeep * out, kPush, Wanted::either);
    draft.hand.to(point + away * out, kPush, Wanted::either);
    return;
  }
}

void draw_file(Draft& draft, const PointCloud& cloud, const FreeAir& air, int ways) {
  Eigen::AlignedBox3d box;
  draft.give_normals = !cloud.normals.empty();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d point = cloud.positions[i].cast<double>() / air.spacing();
    draft.add(point,
              draft.give_normals ? Vector3d(cloud.normals[i].cast<double>()) : Vector3d::UnitZ());
    box.extend(point);
  }
  if (cloud.viewpoint) draft.viewpoint = (*cloud.viewpoint - cloud.origin) / air.spacing();
  const Vector3d margin = 0.1 * box.sizes();
  const Eigen::AlignedBox3d around(box.min() - margin, box.max() + margin);
  for (int i = 0; i < ways; ++i) add_way(draft, air, around);
  for (int i = 0; i < kPresses; ++i) add_press(draft, air);
}

}  // namespace

Row file_row(const std::filesystem::path& path, int ways) {
  const auto cloud = std::make_shared<const PointCloud>(read_cloud(path));
  if (cloud->size() < 2) throw Error(path.string() + " has no two points; give a cloud");
  const auto air = std::make_shared<const FreeAir>(*cloud);
  return {"file", path.filename().string(),
          [=](Draft& draft) { draw_file(draft, *cloud, *air, ways); }};
}

}  // namespace palpate::any_cloud
