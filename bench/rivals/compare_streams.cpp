// Plays methods on the depth streams of table B.
#include <fmt/format.h>

#include "accuracy/truth_scene.hpp"
#include "rivals/modes.hpp"
#include "rivals/play_stream.hpp"
#include "streams/stream_table.hpp"

namespace palpate::rivals {
namespace {

using streams::Setup;
using streams::StreamTrace;

StreamTrace trace_of(const std::vector<Step>& steps, const std::vector<std::size_t>& swaps) {
  StreamTrace trace;
  trace.swaps = swaps;
  for (const Step& step : steps) {
    trace.felt.force.push_back(step.force);
    trace.felt.proxy.push_back(step.proxy);
    trace.normal.push_back(step.force.stableNormalized());
    trace.radius.push_back(0);
  }
  return trace;
}

std::vector<streams::Result> run_experiment(const streams::Experiment& experiment,
                                            const std::vector<Method>& methods) {
  std::vector<streams::Result> results = streams::run_experiment(experiment);
  const accuracy::TruthScene truth = accuracy::make_truth_scene();
  std::vector<std::vector<streams::Measures>> all(methods.size());
  for (const Setup& setup : experiment.setups) {
    const bool still = setup.speed == 0;
    const accuracy::Trace ideal =
        still ? accuracy::ideal_trace(truth, setup.path) : accuracy::Trace{};
    const Played played =
        play_stream({setup.scene, setup.cameras.front(), setup.path.hip, setup.latency}, methods);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      all[k].push_back(streams::measure(setup, trace_of(played.steps[k], played.swaps),
                                        still ? &ideal : nullptr));
    }
  }
  for (std::size_t k = 0; k < methods.size(); ++k) {
    results.push_back(
        {experiment.name, methods[k].after, methods[k].name, streams::together(all[k])});
  }
  return results;
}

}  // namespace

std::string markdown_streams(const bench::SeedOptions& options,
                             const std::vector<Method>& methods) {
  const streams::Options wanted{
      .seeds = options.seeds, .first_seed = options.first_seed, .names = options.names};
  std::string text;
  for (streams::Experiment& experiment : streams::make_experiments(wanted)) {
    if (experiment.setups.front().cameras.size() > 1) continue;
    experiment.contenders = {streams::default_way(), streams::papers_way(1),
                             streams::papers_way(4)};
    text += fmt::format("### {}\n\n{}\n", experiment.name,
                        streams::markdown_experiment(run_experiment(experiment, methods)));
  }
  return text;
}

}  // namespace palpate::rivals
