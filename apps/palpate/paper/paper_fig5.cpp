// Figure 5 of the paper: how long the preparation of clouds takes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/paper/paper_command.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/scene/scene.hpp"
#include "session/frames.hpp"

namespace palpate::app {

namespace {

// Fig. 5 of the paper: points, and ms.
constexpr std::array<std::size_t, 4> kSizes = {146'000, 36'000, 16'000, 2'500};
constexpr std::array<PrepareTimes, 4> kPaper = {
    {{135, 780, 275}, {26, 160, 60}, {10, 70, 25}, {1.4, 10, 3.7}}};

// Computing time that the whole process has used, s: of all its threads, so that work which is
// shared among them counts once and time in which others had the processor does not count.
double computing_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

constexpr double kCloseEnough = 0.005;  // of the size

// The leaf that leaves about so many points; fewer are left the larger it is.
double leaf_for(const PointCloud& cloud, std::size_t wanted) {
  double low = 1e-4;
  double high = 0.2;
  while (high / low > 1.0005) {
    const double leaf = std::sqrt(low * high);
    const std::size_t left = voxel_downsample(cloud, leaf).size();
    const double error = static_cast<double>(left) / static_cast<double>(wanted) - 1;
    if (std::abs(error) < kCloseEnough) return leaf;
    (error > 0 ? low : high) = leaf;
  }
  return low;
}

// Other work on the machine can only add time, so the minimum is used.
double fastest(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

Fig5Row measure(const PointCloud& cloud, std::size_t size, const PrepareTimes& paper, int repeats) {
  Fig5Row row{
      .points = size, .points_here = 0, .voxel = 0, .paper = paper, .here = {}, .weights = 0};
  row.voxel = leaf_for(cloud, size);
  const PointCloud thinned = voxel_downsample(cloud, row.voxel);
  row.points_here = thinned.size();
  PrepareOptions options;
  options.voxel = 0;
  options.paper = true;
  std::vector<double> index;
  std::vector<double> normals;
  std::vector<double> spacing;
  std::vector<double> weights;
  for (int i = 0; i < repeats; ++i) {
    const Prepared::Report report = prepare(thinned, options).report;
    index.push_back(1e3 * report.seconds_index);
    normals.push_back(1e3 * report.seconds_normals);
    spacing.push_back(1e3 * report.seconds_spacing);
    weights.push_back(1e3 * report.seconds_weights);
  }
  row.here = {fastest(index), fastest(normals), fastest(spacing)};
  row.weights = fastest(weights);
  return row;
}

// A recording may have fewer frames than are requested; then those that there are count.
double measure_frames(DepthCamera& camera, DepthFrame frame, int repeats) {
  constexpr int kWarm = 2;  // frames until all memory is there
  Scene scene;
  SourceOptions options;
  options.policy.fit_everywhere = true;
  Source& source = scene.add("frame", options);
  std::vector<double> times;
  for (int i = 0; i < repeats + kWarm; ++i) {
    const double begin = computing_seconds();
    source.push(frame, [&] { return frame.stamp; });
    if (i >= kWarm || times.empty()) times.push_back(1e3 * (computing_seconds() - begin));
    if (i == kWarm) times.erase(times.begin());
    if (camera.read(frame, 0) != DepthCamera::Status::frame) break;
  }
  return fastest(times);
}

}  // namespace

Fig5 measure_fig5(DepthCamera& camera, int repeats) {
  const DepthFrame frame = first_frame(camera);
  const PointCloud cloud = session::cloud_of(frame);
  if (cloud.size() < kSizes.front()) {
    throw Error(fmt::format(
        "the frame has {} points, but the paper's largest cloud has {}; use a larger image",
        cloud.size(), kSizes.front()));
  }
  Fig5 result;
  result.pixels = cloud.size();
  Progress progress("preparing clouds of four sizes");
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    progress.update(static_cast<double>(i) / kSizes.size());
    result.rows.push_back(measure(cloud, kSizes[i], kPaper[i], repeats));
  }
  result.everywhere = measure_frames(camera, frame, repeats);
  return result;
}

}  // namespace palpate::app
