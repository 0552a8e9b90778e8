// Plays all methods on drawn scenes.
#include "rivals/compare.hpp"

#include <algorithm>
#include <atomic>
#include <thread>

#include "accuracy/drawn_scene.hpp"
#include "common/wanted.hpp"
#include "palpate/base/clock.hpp"
#include "rivals/view.hpp"

namespace palpate::rivals {
namespace {

using accuracy::Path;
using accuracy::Row;
using accuracy::Trace;

// Steps that are timed together; judgement: the clock costs as much as a short step does.
constexpr std::size_t kLump = 10;

struct Ground {
  std::uint64_t layout = 0;
  accuracy::TruthScene truth;
  std::vector<Row> rows;
  std::vector<std::vector<Trace>> ideal;  // as rows
};

Ground draw_ground(const accuracy::BenchOptions& options, std::uint64_t layout) {
  Ground ground;
  ground.layout = layout;
  ground.truth = accuracy::draw_truth_scene(layout);
  for (Row& row : accuracy::draw_rows(ground.truth, layout)) {
    if (!bench::is_wanted(row.name, options.rows)) continue;
    ground.ideal.emplace_back();
    for (const Path& path : row.paths) {
      ground.ideal.back().push_back(accuracy::ideal_trace(ground.truth, path));
    }
    ground.rows.push_back(std::move(row));
  }
  return ground;
}

Trace timed(Rival& rival, const Path& path, std::vector<double>& microseconds) {
  Trace trace;
  rival.reset(path.hip.front());
  for (std::size_t i = 0; i < path.hip.size(); i += kLump) {
    const std::size_t end = std::min(i + kLump, path.hip.size());
    bool touching = true;
    const double before = thread_cpu_seconds();
    for (std::size_t k = i; k < end; ++k) {
      const Step step = rival.step(path.hip[k]);
      touching = touching && step.touching;
      trace.force.push_back(step.force);
      trace.proxy.push_back(step.proxy);
    }
    const double each = 1e6 * (thread_cpu_seconds() - before) / static_cast<double>(end - i);
    if (touching) microseconds.push_back(each);
  }
  return trace;
}

void play(const Method& method, const View& view, const Ground& ground, std::uint64_t seed,
          Compared& out) {
  const std::unique_ptr<Rival> rival = method.make(method.scale);
  const double before = thread_cpu_seconds();
  rival->show(view.shown(method));
  Times times{method.name, 1e3 * (thread_cpu_seconds() - before)};
  std::vector<double> steps;
  for (std::size_t r = 0; r < ground.rows.size(); ++r) {
    accuracy::Scorer scorer;
    for (std::size_t i = 0; i < ground.rows[r].paths.size(); ++i) {
      const Path& path = ground.rows[r].paths[i];
      scorer.add(path, ground.ideal[r][i], timed(*rival, path, steps), ground.truth);
    }
    out.scores.results.push_back(
        {seed, method.name, ground.rows[r].name, scorer.score(), ground.layout});
  }
  std::ranges::sort(steps);
  if (!steps.empty()) {
    times.p50 = steps[steps.size() / 2];
    times.p99 = steps[steps.size() * 99 / 100];
  }
  out.times.push_back(times);
}

Compared play_layout(const CompareOptions& options, std::uint64_t layout) {
  Compared out;
  const Ground ground = draw_ground(options.bench, layout);
  const DepthFrame exact = accuracy::exact_frame(ground.truth);
  for (int i = 0; i < options.bench.seeds; ++i) {
    const std::uint64_t seed = options.bench.first_seed + static_cast<std::uint64_t>(i);
    const View view(ground.truth, exact, noise_of(options.bench, layout, seed));
    for (const Method& method : options.methods) play(method, view, ground, seed, out);
  }
  return out;
}

}  // namespace

Trace felt(Rival& rival, const Path& path) {
  std::vector<double> ignored;
  return timed(rival, path, ignored);
}

Compared compare(const CompareOptions& options) {
  const auto layouts = static_cast<std::size_t>(options.bench.layouts);
  std::vector<Compared> parts(layouts);
  std::atomic<std::size_t> next = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < options.threads; ++i) {
      threads.emplace_back([&] {
        for (std::size_t k = next++; k < layouts; k = next++) {
          parts[k] = play_layout(options, options.bench.first_layout + k);
        }
      });
    }
  }
  Compared all;
  for (Compared& part : parts) {
    auto& scores = all.scores.results;
    scores.insert(scores.end(), part.scores.results.begin(), part.scores.results.end());
    all.times.insert(all.times.end(), part.times.begin(), part.times.end());
  }
  return all;
}

}  // namespace palpate::rivals
