// Makes points and a filtered frame of a depth frame.
#include "rivals/view.hpp"

#include "palpate/depth/depth_filter.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate::rivals {
namespace {

DepthFrame filtered_frame(const DepthFrame& frame) {
  DepthFilter filter;
  const FilteredDepth& found = filter.filter(frame, *frame.T_world_sensor);
  DepthFrame out;
  out.stamp = frame.stamp;
  out.T_world_sensor = frame.T_world_sensor;
  const Pinhole& p = frame.camera.pinhole;
  out.camera = {
      found.columns, found.rows, {p.fx / 2, p.fy / 2, (p.cx - 0.5) / 2, (p.cy - 0.5) / 2}, {}};
  out.depth.resize(found.size(), 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found.states[i] != FilteredDepth::State::empty) out.depth[i] = found.positions[i].z();
  }
  return out;
}

PointCloud world_cloud(const DepthFrame& frame) {
  PointCloud cloud = accuracy::back_project(frame);
  const Eigen::Isometry3f pose = frame.T_world_sensor->cast<float>();
  for (Eigen::Vector3f& p : cloud.positions) p = pose * p;
  cloud.viewpoint = frame.T_world_sensor->translation();
  return cloud;
}

DepthFrame seen_frame(const accuracy::TruthScene& truth, const DepthFrame& exact,
                      const SimulatedNoiseOptions& noise) {
  DepthFrame frame = accuracy::noisy_frame(exact, noise);
  frame.T_world_sensor = truth.camera.T_world_camera;
  return frame;
}

}  // namespace

View::View(DepthFrame seen, double known_spacing)
    : frame(std::move(seen)),
      filtered(filtered_frame(frame)),
      cloud(world_cloud(frame)),
      spacing(known_spacing > 0 ? known_spacing : spacing_of(cloud)) {}

View::View(const accuracy::TruthScene& truth, const DepthFrame& exact,
           const SimulatedNoiseOptions& noise)
    : View(seen_frame(truth, exact, noise)) {}

double spacing_of(const PointCloud& cloud) {
  return median(local_spacings(CellGrid(cloud.positions)));
}

}  // namespace palpate::rivals
