// Plays methods on depth streams: each frame replaces the one before when it can be felt.
#include "rivals/compare_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "accuracy/truth_frame.hpp"
#include "palpate/sensor/stream.hpp"
#include "rivals/compare.hpp"
#include "streams/stream_table.hpp"

namespace palpate::rivals {
namespace {

using Eigen::Vector3d;
using streams::kTick;
using streams::Setup;
using streams::StreamTrace;

constexpr double kLead = 0.002;  // s, from publishing to the start of a surface; as table B has it

// The newest frame, and when it is to be felt.
struct Waiting {
  DepthFrame frame;
  double start = 0;
};

void add(StreamTrace& trace, const Step& step) {
  trace.felt.force.push_back(step.force);
  trace.felt.proxy.push_back(step.proxy);
  trace.normal.push_back(step.force.stableNormalized());
  trace.radius.push_back(0);
}

void show(Rival& rival, const Method& method, const DepthFrame& frame, double& spacing) {
  const PointCloud cloud = world_cloud(frame);
  if (spacing == 0) spacing = spacing_of(cloud);
  const DepthFrame given = method.filtered ? filtered_frame(frame) : frame;
  rival.show({&given, &cloud, spacing});
}

StreamTrace run_stream(const Setup& setup, const Method& method) {
  StreamTrace trace;
  const std::unique_ptr<Rival> rival = method.make(method.scale);
  SimulatedCamera camera(setup.scene, setup.cameras.front());
  std::optional<Waiting> waiting;
  SimulatedStream stream(camera, method.name,
                         [&](const DepthFrame& frame, const Source::StartTime& start) {
                           waiting = {frame, start()};
                         },
                         {.latency = setup.latency, .lead = kLead});
  double spacing = 0;
  for (std::size_t i = 0; i < setup.path.hip.size(); ++i) {
    const double now = static_cast<double>(i) * kTick;
    stream.advance(now);
    if (waiting && waiting->start <= now + 1e-9) {
      const bool first = spacing == 0;
      show(*rival, method, waiting->frame, spacing);
      waiting.reset();
      if (first) rival->reset(setup.path.hip[i]);
      trace.swaps.push_back(i);
    }
    add(trace, spacing == 0 ? spring(setup.path.hip[i], setup.path.hip[i])
                            : rival->step(setup.path.hip[i]));
  }
  return trace;
}

std::vector<streams::Result> run_experiment(const streams::Experiment& experiment,
                                            const std::vector<Method>& methods) {
  std::vector<streams::Result> results = streams::run_experiment(experiment);
  const accuracy::TruthScene truth = accuracy::make_truth_scene();
  for (const Method& method : methods) {
    std::vector<streams::Measures> all;
    for (const Setup& setup : experiment.setups) {
      const bool still = setup.speed == 0;
      const accuracy::Trace ideal =
          still ? accuracy::ideal_trace(truth, setup.path) : accuracy::Trace{};
      all.push_back(streams::measure(setup, run_stream(setup, method), still ? &ideal : nullptr));
    }
    results.push_back({experiment.name, method.after, method.name, streams::together(all)});
  }
  return results;
}

}  // namespace

std::string markdown_streams(const streams::Options& options, const std::vector<Method>& methods) {
  std::vector<Method> others = methods;
  std::erase_if(others, [](const Method& m) { return *m.length == 0; });
  std::string text;
  for (streams::Experiment& experiment : streams::make_experiments(options)) {
    if (experiment.setups.front().cameras.size() > 1) continue;
    experiment.contenders = {streams::default_way(), streams::papers_way(1),
                             streams::papers_way(4)};
    text += fmt::format("### {}\n\n{}\n", experiment.name,
                        streams::markdown_experiment(run_experiment(experiment, others)));
  }
  return text;
}

}  // namespace palpate::rivals
