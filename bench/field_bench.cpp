// What one evaluation of the metaball sum with its gradient costs, beside nanoflann's radius search
// with the same sum (the seed's way: search in every tick, then add up).

#include <benchmark/benchmark.h>

#include <cmath>
#include <nanoflann.hpp>
#include <random>
#include <vector>

#include "field/evaluate.hpp"
#include "field/patch.hpp"
#include "palpate/field/kernel.hpp"
#include "palpate/field/surface_points.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using namespace palpate;

constexpr double kRadiusOfSphere = 0.1;  // m

/// A bumpy, noisy sphere of about `count` points, evenly spread.
std::vector<Vector3f> bumpy_sphere(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.2e-3);
  std::vector<Vector3f> points;
  const double golden = M_PI * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - 2 * (i + 0.5) / count;
    const double ring = std::sqrt(1 - z * z);
    const Vector3d d(ring * std::cos(golden * i), ring * std::sin(golden * i), z);
    const double r = kRadiusOfSphere + 2e-3 * std::sin(9 * d.x()) * std::cos(7 * d.y());
    points.push_back((d * (r + noise(random))).cast<float>());
  }
  return points;
}

struct Cloud {
  std::vector<Vector3f> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud,
                                                 3, std::uint32_t>;

double spacing_of(std::size_t count) {
  return kRadiusOfSphere * std::sqrt(4 * M_PI / static_cast<double>(count));
}

/// Places that a proxy visits: a path along the surface, 0.1 mm a step.
std::vector<Vector3d> path() {
  std::vector<Vector3d> places;
  for (int k = 0; k < 1000; ++k) {
    const double a = 1e-3 * k;
    places.push_back(kRadiusOfSphere * Vector3d(std::cos(a), std::sin(a), 0));
  }
  return places;
}

void nanoflann_sum(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const Cloud cloud{bumpy_sphere(count)};
  const Tree tree(3, cloud, {10});
  const double radius = 2.5 * spacing_of(count);
  const auto places = path();
  nanoflann::SearchParams unsorted(32, 0, false);
  std::vector<std::pair<std::uint32_t, float>> found;
  found.reserve(256);
  std::size_t k = 0;
  double neighbours = 0;
  for (auto _ : state) {
    const Vector3d& x = places[k++ % places.size()];
    const Vector3f query = x.cast<float>();
    tree.radiusSearch(query.data(), static_cast<float>(radius * radius), found, unsorted);
    double sum = 0;
    Vector3d gradient = Vector3d::Zero();
    for (const auto& [i, squared] : found) {
      const Vector3d q = cloud.points[i].cast<double>() - x;
      const KernelValue w = wyvill(q.squaredNorm() / (radius * radius));
      sum += w.w;
      gradient -= w.g / (radius * radius) * q;
    }
    neighbours += static_cast<double>(found.size());
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(gradient);
  }
  state.counters["neighbours"] = neighbours / static_cast<double>(state.iterations());
}

SurfacePoints surface_points(std::size_t count) {
  SurfacePoints points;
  const auto positions = bumpy_sphere(count);
  points.grid = CellGrid(positions);
  points.radii.assign(count, static_cast<float>(2.5 * spacing_of(count)));
  points.density_weights.assign(count, 1.0f);
  points.confidences.assign(count, 1.0f);
  finish(points);
  return points;
}

/// `gather_always`: search in every evaluation; else once and while the patch is valid, as a field
/// does it.
void palpate_sum(benchmark::State& state, bool gather_always) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const SurfacePoints points = surface_points(count);
  const std::vector<ActiveLayer> layers{{&points}};
  const ImplicitSurface surface{
      FieldOptions{.kind = FieldKind::metaball, .threshold = 0.5, .raw_weights = true}};
  Patch patch(2048);
  const double radius = 2.5 * spacing_of(count);
  const auto places = path();
  std::size_t k = 0;
  double gathers = 0;
  for (auto _ : state) {
    const Vector3d& x = places[k++ % places.size()];
    if (gather_always || !patch.covers({x, 0})) {
      patch.gather(layers, 1, x, gather_always ? 0 : 0.5 * radius, true);
      ++gathers;
    }
    benchmark::DoNotOptimize(evaluate(surface, patch, x, 1));
  }
  state.counters["patch"] = static_cast<double>(patch.points());
  state.counters["gathers"] = gathers / static_cast<double>(state.iterations());
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(36000)->Arg(146000);
}

BENCHMARK(nanoflann_sum)->Apply(sizes);
BENCHMARK_CAPTURE(palpate_sum, patch, false)->Apply(sizes);
BENCHMARK_CAPTURE(palpate_sum, search_every_time, true)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
