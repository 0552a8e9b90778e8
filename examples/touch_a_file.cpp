// Touches a file: reads it, prepares it, and lets a hand come down onto its middle.
//
//   touch_a_file bunny.ply
#include <cstdio>
#include <palpate/palpate.hpp>
#include <vector>

namespace {

using Eigen::Vector3d;

// The point nearest to the middle of the cloud, and how far away is well outside, m.
struct Target {
  Vector3d place;
  Vector3d outside;
};

Target middle_of(const palpate::SurfacePoints& points) {
  const Eigen::Vector3f center = (points.bounds().center() - points.origin).cast<float>();
  std::vector<palpate::CellGrid::Neighbor> found;
  points.grid.nearest(center, 1, found);
  const Vector3d place = points.origin + points.grid.points()[found.front().index].cast<double>();
  Vector3d normal = Vector3d::UnitZ();
  if (!points.normals.empty()) normal = points.normals[found.front().index].cast<double>();
  return {place, place + 10 * points.radius * normal};
}

void touch(const char* file) {
  palpate::Scene scene;
  const palpate::Source& source = scene.add("file", palpate::read_cloud(file));
  const palpate::Prepared::Report& report = source.report();
  std::printf("%zu points, spacing %.4g m, R %.4g m\n", report.points_out, report.spacing,
              report.radius);

  const Target target = middle_of(*source.points());
  palpate::SceneField field(scene);
  palpate::Proxy proxy({.stiffness = 500.0});  // N/m
  const double period = 1e-3;                  // s
  double largest = 0;                          // N
  for (int step = 0; step <= 1000; ++step) {
    const Vector3d hand = target.outside + (target.place - target.outside) * (1.1e-3 * step);
    field.update(step * period, hand, proxy);
    const palpate::Contact contact = proxy.step(field, hand, period);
    if (contact.force.norm() > largest) largest = contact.force.norm();
    if (step % 10 == 0) std::printf("%.3f s: %.3f N\n", step * period, contact.force.norm());
  }
  std::printf("largest force %.3f N\n", largest);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: touch_a_file CLOUD\n");
    return 2;
  }
  try {
    touch(arguments[1]);
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
