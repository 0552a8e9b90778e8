// Measures one evaluation of the metaball sum with its gradient beside nanoflann's radius search
// with the same sum (the seed's way: search in every tick, then add up).

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "clouds.hpp"
#include "field/evaluate.hpp"
#include "field/formulas.hpp"
#include "field/patch.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/field/surface_points.hpp"
#include "peers/nanoflann_tree.hpp"

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using namespace palpate;

constexpr double kRadiusOfSphere = 0.1;  // m; derived: that of bumpy_sphere()

/// Where a proxy asks: along the surface at 10 cm/s, four evaluations in a step of 1 ms.
std::vector<Vector3d> path() {
  std::vector<Vector3d> places;
  for (int k = 0; k < 4000; ++k) {
    const double a = 0.25e-3 * k;
    places.push_back(kRadiusOfSphere * Vector3d(std::cos(a), std::sin(a), 0));
  }
  return places;
}

void nanoflann_sum(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const std::vector<Vector3f> points = bench::bumpy_sphere(count);
  const bench::NanoflannPoints cloud{points};
  const bench::NanoflannTree tree(3, cloud, {10});
  const double radius = 2.5 * bench::bumpy_sphere_spacing(count);
  const auto places = path();
  nanoflann::SearchParams unsorted(32, 0, false);
  std::vector<std::pair<std::uint32_t, float>> found;
  found.reserve(256);
  std::size_t k = 0;
  double neighbours = 0;
  for (auto _ : state) {
    const Vector3d& x = places[k];
    k = k + 1 < places.size() ? k + 1 : 0;
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
  const auto positions = bench::bumpy_sphere(count);
  points.grid = CellGrid(positions);
  points.radii.assign(count, static_cast<float>(2.5 * bench::bumpy_sphere_spacing(count)));
  points.density_weights.assign(count, 1.0f);
  points.confidences.assign(count, 1.0f);
  for (const auto& p : points.grid.points()) points.normals.push_back(p.normalized());
  finish(points);
  return points;
}

/// A patch as a field keeps it: gathered anew when the path has left it.
class Walk {
 public:
  Walk(std::size_t count, bool normals)
      : points_(surface_points(count)),
        margin_(0.35 * 2.5 * bench::bumpy_sphere_spacing(count)),
        gather_{.raw_weights = true, .normals = normals} {}

  const Patch& at(const Vector3d& x) {
    if (!patch_.covers({x, 0})) {
      patch_.gather(layers_, 1, x, margin_, gather_);
      ++gathers_;
    }
    return patch_;
  }

  void report(benchmark::State& state) const {
    state.counters["patch"] = static_cast<double>(patch_.points());
    state.counters["gathers"] = gathers_ / static_cast<double>(state.iterations());
  }

 private:
  SurfacePoints points_;
  std::vector<ActiveLayer> layers_{{&points_}};
  Patch patch_{2048};
  double margin_;
  GatherOptions gather_;
  double gathers_ = 0;
};

/// The sum and its gradient, as nanoflann_sum has them.
void palpate_sum(benchmark::State& state) {
  Walk walk(static_cast<std::size_t>(state.range(0)), false);
  const auto places = path();
  std::size_t k = 0;
  simd::Sums sums;
  for (auto _ : state) {
    const Vector3d& x = places[k];
    k = k + 1 < places.size() ? k + 1 : 0;
    const Patch& patch = walk.at(x);
    const Vector3d local = x - patch.center();
    simd::best_sums().weights(patch.columns(), false, local.data(), sums);
    benchmark::DoNotOptimize(sums);
  }
  walk.report(state);
}

/// A whole sample of a field.
void palpate_sample(benchmark::State& state, FieldOptions::Kind kind) {
  Walk walk(static_cast<std::size_t>(state.range(0)), kind != FieldOptions::Kind::metaball);
  const ImplicitSurface surface{FieldOptions{.kind = kind}};
  const auto places = path();
  std::size_t k = 0;
  for (auto _ : state) {
    const Vector3d& x = places[k];
    k = k + 1 < places.size() ? k + 1 : 0;
    benchmark::DoNotOptimize(evaluate(surface, walk.at(x), x));
  }
  walk.report(state);
}

void add_rows(std::size_t count) {
  const auto points = static_cast<std::int64_t>(count);
  const auto row = [&](const std::string& name, auto body) {
    benchmark::RegisterBenchmark((name + "/" + std::to_string(count)).c_str(), body)->Arg(points);
  };
  row("metaball_sum/palpate", palpate_sum);
  row("metaball_sum/nanoflann", nanoflann_sum);
  row("sample_metaball/palpate",
      [](benchmark::State& state) { palpate_sample(state, FieldOptions::Kind::metaball); });
  row("sample_balanced/palpate",
      [](benchmark::State& state) { palpate_sample(state, FieldOptions::Kind::balanced); });
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::size_t count : {36000, 146000}) add_rows(count);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
