// Plays table A: every layout, frame, contender and row.
#include "accuracy/bench_run.hpp"

#include <algorithm>

#include "accuracy/drawn_scene.hpp"
#include "common/wanted.hpp"

namespace palpate::accuracy {
namespace {

struct IdealRow {
  Row row;
  std::vector<Trace> ideal;
};

// A layout with the paths on it.
struct Ground {
  std::uint64_t layout = 0;
  TruthScene truth;
  std::vector<IdealRow> rows;
};

Ground ground_of(const BenchOptions& options, int i) {
  Ground ground;
  std::vector<Row> rows;
  if (options.layouts > 0) {
    ground.layout = options.first_layout + static_cast<std::uint64_t>(i);
    ground.truth = draw_truth_scene(ground.layout);
    rows = draw_rows(ground.truth, ground.layout);
  } else {
    ground.layout = static_cast<std::uint64_t>(options.layout);
    ground.truth = make_truth_scene(options.layout);
    rows = make_rows(ground.truth);
  }
  for (Row& row : rows) {
    if (!bench::is_wanted(row.name, options.rows)) continue;
    IdealRow ideal{std::move(row), {}};
    for (const Path& path : ideal.row.paths) {
      ideal.ideal.push_back(ideal_trace(ground.truth, path));
    }
    ground.rows.push_back(std::move(ideal));
  }
  return ground;
}

// Contenders that prepare alike share a scene.
bool prepared_alike(const Contender& a, const Contender& b) {
  return a.organised == b.organised && a.prepare.paper == b.prepare.paper;
}

Score score_row(Scene& scene, const Contender& contender, const IdealRow& ideal,
                const TruthScene& truth) {
  Scorer scorer;
  for (std::size_t i = 0; i < ideal.row.paths.size(); ++i) {
    const Path& path = ideal.row.paths[i];
    scorer.add(path, ideal.ideal[i], rendered_trace(scene, contender, path), truth);
  }
  return scorer.score();
}

void run_layout(const BenchOptions& options, const Ground& ground,
                const std::vector<Contender>& contenders, BenchResults& out) {
  const DepthFrame exact = exact_frame(ground.truth);
  for (int i = 0; i < options.seeds; ++i) {
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
    const DepthFrame frame = noisy_frame(exact, noise_of(options, ground.layout, seed));
    std::unique_ptr<Scene> scene;
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      const Contender& contender = contenders[k];
      if (!scene || !prepared_alike(contender, contenders[k - 1])) {
        scene = make_scene(frame, ground.truth, contender);
      }
      const Source& source = scene->source(0);
      out.preparations.push_back({seed, contender.name, source.report(), source.state()});
      for (const IdealRow& row : ground.rows) {
        out.results.push_back({seed, contender.name, row.row.name,
                               score_row(*scene, contender, row, ground.truth), ground.layout});
      }
    }
  }
}

}  // namespace

NoiseKind noise_kind(const std::string& letter) {
  if (letter == "a") return NoiseKind::independent;
  if (letter == "b") return NoiseKind::blurred;
  return letter == "c" ? NoiseKind::quantised : NoiseKind::none;
}

SimulatedNoiseOptions noise_of(const BenchOptions& options, std::uint64_t layout,
                               std::uint64_t seed) {
  SimulatedNoiseOptions noise;
  noise.kind = options.noise;
  noise.seed = options.layouts > 0 ? seed + 1000003 * layout : seed;
  noise.rounding = options.rounding;
  noise.silhouettes = options.silhouettes;
  noise.correlation = options.correlation;
  // The layouts are some 0.7 m away.
  noise.disparity_step = std::min(options.terraces * 525 * 0.075 / (0.7 * 0.7), 8.0);
  if (options.sigma > 0) noise.model.coefficients = {options.sigma, 0, 0};
  return noise;
}

TruthCamera camera_of(const BenchOptions& options) {
  TruthCamera camera;
  if (options.fine) camera.model = {1280, 720, {900, 900, 639.5, 359.5}, {}};
  return camera;
}

BenchResults run_bench(const BenchOptions& options, const std::vector<Contender>& contenders) {
  BenchResults out;
  for (int i = 0; i < std::max(1, options.layouts); ++i) {
    run_layout(options, ground_of(options, i), contenders, out);
  }
  return out;
}

}  // namespace palpate::accuracy
