#include "accuracy/bench_run.hpp"

#include <algorithm>

namespace palpate::accuracy {
namespace {

struct IdealRow {
  Row row;
  std::vector<Trace> ideal;
};

bool wanted(const std::string& name, const std::vector<std::string>& parts) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

std::vector<IdealRow> ideal_rows(const TruthScene& truth, const BenchOptions& options) {
  std::vector<IdealRow> rows;
  for (Row& row : make_rows(truth)) {
    if (!wanted(row.name, options.rows)) continue;
    IdealRow ideal{std::move(row), {}};
    for (const Path& path : ideal.row.paths) ideal.ideal.push_back(ideal_trace(truth, path));
    rows.push_back(std::move(ideal));
  }
  return rows;
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

}  // namespace

BenchResults run_bench(const BenchOptions& options, const std::vector<Contender>& contenders) {
  const TruthScene truth = make_truth_scene(options.layout);
  const DepthFrame exact = exact_frame(truth);
  const std::vector<IdealRow> rows = ideal_rows(truth, options);
  BenchResults out;
  for (int i = 0; i < options.seeds; ++i) {
    const std::uint64_t seed = options.first_seed + static_cast<std::uint64_t>(i);
    SimulatedNoiseOptions noise;
    noise.kind = options.noise;
    noise.seed = seed;
    noise.silhouettes = options.silhouettes;
    const DepthFrame frame = noisy_frame(exact, noise);
    std::unique_ptr<Scene> scene;
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      const Contender& contender = contenders[k];
      if (!scene || !prepared_alike(contender, contenders[k - 1])) {
        scene = make_scene(frame, truth, contender);
      }
      const Source& source = scene->source(0);
      out.preparations.push_back({seed, contender.name, source.report(), source.state()});
      for (const IdealRow& row : rows) {
        out.results.push_back(
            {seed, contender.name, row.row.name, score_row(*scene, contender, row, truth)});
      }
    }
  }
  return out;
}

}  // namespace palpate::accuracy
