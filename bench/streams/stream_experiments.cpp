// Lists the experiments of table B and runs them.
#include "streams/stream_experiments.hpp"

#include <algorithm>
#include <cmath>

#include "accuracy/score.hpp"
#include "common/wanted.hpp"

namespace palpate::streams {
namespace {

constexpr double kFast = 0.10;     // m/s
constexpr double kSlow = 0.02;     // m/s
constexpr double kJitter = 0.015;  // s
constexpr double kFastest = 0.7;   // s that a fast surface has room for

std::vector<Contender> policies() {
  return {papers_way(1),
          papers_way(4),
          of_clouds(Policy::replace, 1),
          of_clouds(Policy::average, 4),
          of_clouds(Policy::crossfade, 4),
          morph()};
}

std::vector<Contender> on_moving_surfaces() {
  return {papers_way(4), of_clouds(Policy::crossfade, 1), morph()};
}

std::vector<Contender> figure_seven() {
  return {papers_figure(1), papers_figure(2), papers_figure(3), papers_figure(4)};
}

class Maker {
 public:
  explicit Maker(const Options& options) : options_(options) {}

  // `make` gives the set-ups for one seed.
  template <class Make>
  void add(const std::string& name, const Frames& frames, std::vector<Contender> others,
           const Make& make) {
    if (!bench::is_wanted(name, options_.names)) return;
    Experiment experiment{name, {}, {default_way()}};
    if (!options_.ours_alone) {
      experiment.contenders.insert(experiment.contenders.end(), others.begin(), others.end());
    }
    for (int i = 0; i < options_.seeds; ++i) {
      Frames seeded = frames;
      seeded.seed = options_.first_seed + static_cast<std::uint64_t>(i);
      for (Setup& setup : make(seeded)) experiment.setups.push_back(std::move(setup));
    }
    made_.push_back(std::move(experiment));
  }

  [[nodiscard]] std::vector<Experiment> take() { return std::move(made_); }

 private:
  Options options_;
  std::vector<Experiment> made_;
};

std::vector<Setup> slides(const Frames& frames) {
  return {sphere_slide(frames, 0), sphere_slide(frames, 1)};
}

void add_still(Maker& maker, const Frames& a) {
  Frames c = a;
  c.noise = NoiseKind::quantised;
  Frames irregular = a;
  irregular.jitter = kJitter;
  const auto press = [](const Frames& frames) { return std::vector{static_press(frames)}; };
  maker.add("static press, noise a", a, policies(), press);
  maker.add("static press, noise c", c, policies(), press);
  maker.add("the setting of Fig. 7", a, figure_seven(), press);
  maker.add("irregular frames, press", irregular, {}, press);
  maker.add("sphere slide", a, {}, slides);
  maker.add("irregular frames, slide", irregular, {}, slides);
}

void add_moving(Maker& maker, const Frames& slow) {
  Frames fast = slow;
  fast.seconds = std::min(fast.seconds, kFastest);
  const auto plane = [](double speed) {
    return [speed](const Frames& frames) { return std::vector{plane_comes(frames, speed)}; };
  };
  const auto ball = [](double speed) {
    return [speed](const Frames& frames) { return std::vector{ball_comes(frames, speed)}; };
  };
  maker.add("plane comes at 10 cm/s", fast, on_moving_surfaces(), plane(kFast));
  maker.add("plane comes at 2 cm/s", slow, on_moving_surfaces(), plane(kSlow));
  maker.add("ball comes at 10 cm/s", fast, on_moving_surfaces(), ball(kFast));
  maker.add("ball comes at 2 cm/s", slow, on_moving_surfaces(), ball(kSlow));
  maker.add("camera moves", slow, {},
            [](const Frames& frames) { return std::vector{camera_moves(frames)}; });
  const auto two = [](int part) {
    return [part](const Frames& frames) { return std::vector{two_cameras(frames, part)}; };
  };
  maker.add("two cameras, table", slow, {}, two(0));
  maker.add("two cameras, sphere", slow, {}, two(1));
}

}  // namespace

Measures together(const std::vector<Measures>& all) {
  Measures out;
  const auto n = static_cast<double>(all.size());
  const auto join = [&](double Measures::*of) {
    for (const Measures& m : all) out.*of += m.*of * (m.*of) / n;
    out.*of = std::sqrt(out.*of);
  };
  for (const auto of :
       {&Measures::jump, &Measures::jump_high, &Measures::vibration, &Measures::ripple,
        &Measures::force, &Measures::normal, &Measures::normal_sd, &Measures::lag_sd}) {
    join(of);
  }
  for (const Measures& m : all) {
    out.lag += m.lag / n;
    out.radius += m.radius / n;
    out.contact += m.contact / n;
    out.step = std::max(out.step, m.step);
    out.pops += m.pops;
  }
  return out;
}

std::vector<Experiment> make_experiments(const Options& options) {
  Maker maker(options);
  Frames frames;
  frames.seconds = options.seconds;
  add_still(maker, frames);
  add_moving(maker, frames);
  return maker.take();
}

std::vector<Result> run_experiment(const Experiment& experiment) {
  const accuracy::TruthScene truth = accuracy::make_truth_scene();
  std::vector<std::vector<std::vector<Measures>>> all(experiment.contenders.size());
  for (const Setup& setup : experiment.setups) {
    const bool still = setup.speed == 0;
    const accuracy::Trace ideal = still ? ideal_trace(truth, setup.path) : accuracy::Trace{};
    for (std::size_t i = 0; i < experiment.contenders.size(); ++i) {
      const std::vector<StreamTrace> traces = run_stream(setup, experiment.contenders[i]);
      all[i].resize(traces.size());
      for (std::size_t k = 0; k < traces.size(); ++k) {
        all[i][k].push_back(measure(setup, traces[k], still ? &ideal : nullptr));
      }
    }
  }
  std::vector<Result> results;
  for (std::size_t i = 0; i < experiment.contenders.size(); ++i) {
    const Contender& contender = experiment.contenders[i];
    for (std::size_t k = 0; k < contender.tools.size(); ++k) {
      results.push_back(
          {experiment.name, contender.name, contender.tools[k].name, together(all[i][k])});
    }
  }
  return results;
}

}  // namespace palpate::streams
