// Moves random hands with four tools through formulas and clouds: how deep samples get, what closed
// paths give, and what a step takes beside that of a point on the same path.
#include "common/main.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "palpate/contact/proxy.hpp"
#include "palpate/field/analytic.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/tool/tool_field.hpp"
#include "tools/hands.hpp"

namespace palpate::tools_bench {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 4> kTools = {"box:20x30x10", "capsule:50x4", "cylinder:30x6",
                                               "gripper:6x12x30"};
constexpr double kAllowedOnFormulas = 0.02;  // R
constexpr double kAllowedOnClouds = 0.05;    // R
constexpr double kFormulaRadius = 0.01;      // R of the formula, m
constexpr double kFormulaSize = 0.05;        // m, that the hand wanders around
constexpr double kWanders = 0.5;             // of a cloud's longest half side (judgement)
constexpr double kLargestScene = 0.12;       // m: of larger ones a part is enough (judgement)

struct Options {
  bench::SeedOptions seeds;
  std::vector<std::string> scenes = {"formula", "torus", "rabbit"};
  std::uint64_t steps = 20'000;
  double spacing = 0.5;  // R
};

void print_head() {
  fmt::print(
      "| scene, tool | samples | steps | touching | open | not finite | deepest, R | too deep "
      "| given, mJ | touching: p50, p99, p99.9 us | free p50 | point: p50, p99.9 |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const std::string& name, std::size_t samples, Met& met, Met& point) {
  const auto share = [](auto part, auto of) {
    return of > 0 ? 100 * static_cast<double>(part) / static_cast<double>(of) : 0;
  };
  fmt::print(
      "| {} | {} | {} | {:.0f} % | {:.2f} % | {} | {:.3f} | {} of {} | {:.3f} | {:.1f}, {:.0f}, "
      "{:.0f} | {:.1f} | {:.1f}, {:.1f} |\n",
      name, samples, met.steps, share(met.touching, met.steps), share(met.open, met.steps),
      met.not_finite, met.deepest, met.deep, met.looked, 1e3 * met.given,
      quantile(met.touch_us, 0.5), quantile(met.touch_us, 0.99), quantile(met.touch_us, 0.999),
      quantile(met.free_us, 0.5), quantile(point.touch_us, 0.5), quantile(point.touch_us, 0.999));
  std::fflush(stdout);
}

// A torus, a box and a floor, with the creases in which they meet.
struct Formula {
  AnalyticField::Options options{.resolution = kFormulaRadius / 16};
  TorusField torus{0.05, 0.02, options};
  BoxField box{{0.03, 0.08, 0.04}, options};
  PlaneField floor{options};
  UnionField all{{&torus, &box, &floor}};
};

Stage stage_of(const Field& field) {
  return {.update = [](double, const Pose&, const ToolProxy&) {},
          .step = [&](ToolProxy& proxy, const Pose& hand) { return proxy.step(field, hand, 1e-3); },
          .depths =
              [&](const ToolProxy& proxy, const auto& see) {
                for (const Tool::Point& each : proxy.tool().samples()) {
                  const Vector3d x = proxy.tool().in_world(each.position, each.side, proxy.pose());
                  see((each.radius - field.sample(x).value) / kFormulaRadius);
                }
              }};
}

Stage stage_of(ToolField& field) {
  return {.update = [&](double now, const Pose& hand,
                        const ToolProxy& proxy) { field.update(now, hand, proxy); },
          .step = [&](ToolProxy& proxy, const Pose& hand) { return proxy.step(field, hand, 1e-3); },
          .depths =
              [&](const ToolProxy& proxy, const auto& see) {
                const auto samples = proxy.tool().samples();
                for (std::size_t i = 0; i < samples.size(); ++i) {
                  const Vector3d x =
                      proxy.tool().in_world(samples[i].position, samples[i].side, proxy.pose());
                  const int group = field.group_of(static_cast<int>(i));
                  const Sample here = field.group(group).sample(x);
                  const double slope = here.gradient.norm();
                  if (!(slope > 0) || here.averted || !(here.radius > 0)) continue;
                  see((samples[i].radius - here.value / slope) / here.radius);
                }
              }};
}

// The same path with a point.
template <class Update, class Surface>
Met wander_point(WanderingHand hand, std::uint64_t steps, const Update& update,
                 const Surface& field) {
  Met met;
  Proxy proxy({.stiffness = 500});
  proxy.reset(hand.start().position);
  for (std::uint64_t i = 0; i < steps; ++i) {
    const Vector3d now = hand.next().position;
    const double begin = thread_seconds();
    update(1e-3 * static_cast<double>(i), now, proxy);
    const Contact contact = proxy.step(field, now, 1e-3);
    const auto us = static_cast<float>(1e6 * (thread_seconds() - begin));
    (contact.touching ? met.touch_us : met.free_us).push_back(us);
  }
  return met;
}

void add(Met& sum, Met&& one) {
  sum.steps += one.steps;
  sum.touching += one.touching;
  sum.open += one.open;
  sum.not_finite += one.not_finite;
  sum.looked += one.looked;
  sum.deep += one.deep;
  sum.deepest = std::max(sum.deepest, one.deepest);
  sum.given = std::max(sum.given, one.given);
  sum.touch_us.insert(sum.touch_us.end(), one.touch_us.begin(), one.touch_us.end());
  sum.free_us.insert(sum.free_us.end(), one.free_us.begin(), one.free_us.end());
}

void run_formula(const Options& options) {
  const Formula formula;
  for (const char* name : kTools) {
    const auto tool =
        std::make_shared<const Tool>(Tool::from_text(name, options.spacing * kFormulaRadius));
    Met all;
    Met point;
    for (int k = 0; k < options.seeds.seeds; ++k) {
      const WanderingHand hand(options.seeds.first_seed + static_cast<std::uint64_t>(k),
                               {0, 0, 0.02}, kFormulaSize);
      add(all, wander(stage_of(formula.all), tool, hand, options.steps, kAllowedOnFormulas));
      add(point, wander_point(
                     hand, options.steps, [](double, auto&, auto&) {}, formula.all));
    }
    print_row(fmt::format("formula, {}", name), tool->samples().size(), all, point);
  }
}

void run_cloud(const std::string& scene_name, const Options& options) {
  const bool is_file = std::filesystem::exists(scene_name);
  Scene scene;
  scene.add("cloud", is_file ? read_cloud_file(scene_name).cloud : synthetic_cloud(scene_name));
  const auto points = scene.source(0).points();
  const Box box = points->bounds();
  const double size = std::min(kWanders * (box.upper - box.lower).maxCoeff(), kLargestScene);
  for (const char* name : kTools) {
    const auto tool =
        std::make_shared<const Tool>(Tool::from_text(name, options.spacing * points->radius));
    Met all;
    Met point;
    for (int k = 0; k < options.seeds.seeds; ++k) {
      const WanderingHand hand(options.seeds.first_seed + static_cast<std::uint64_t>(k),
                               0.5 * (box.lower + box.upper), size);
      ToolField field(scene, tool);
      add(all, wander(stage_of(field), tool, hand, options.steps, kAllowedOnClouds));
      SceneField alone(scene);
      const auto update = [&](double now, const Vector3d& at, const Proxy& proxy) {
        alone.update(now, at, proxy);
      };
      add(point, wander_point(hand, options.steps, update, alone));
    }
    print_row(fmt::format("{}, {}", std::filesystem::path(scene_name).filename().string(), name),
              tool->samples().size(), all, point);
  }
}

int run(const Options& options) {
  print_head();
  for (const std::string& name : options.scenes) {
    name == "formula" ? run_formula(options) : run_cloud(name, options);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::tools_bench

int main(int argc, char** argv) {
  CLI::App app("Random hands with tools that turn", "tools_bench");
  palpate::tools_bench::Options options;
  app.add_option("scenes", options.scenes, "formula, names of synthetic clouds, files of clouds");
  app.add_option("--steps", options.steps, "Of each hand");
  app.add_option("--spacing", options.spacing, "Of samples, R");
  palpate::bench::add_options(app, options.seeds);
  return palpate::bench::run_main(app, argc, argv,
                                  [&] { return palpate::tools_bench::run(options); });
}
