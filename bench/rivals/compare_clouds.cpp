// Plays methods on clouds that surfaces are hard to tell of.
#include "any_cloud/rows.hpp"
#include "any_cloud/score.hpp"
#include "palpate/base/error.hpp"
#include "rivals/method_table.hpp"
#include "rivals/modes.hpp"
#include "rivals/view.hpp"

namespace palpate::rivals {
namespace {

using any_cloud::HandTick;
using any_cloud::HostileScene;
using any_cloud::Score;

constexpr double kSpacing = 1e-3;  // m; derived: 0.5 N a spacing are 500 N/m then

constexpr bench::Column<Score> kColumns[] = {
    {"force error, N", &Score::force_error, 2},
    {"of the ideal force", &Score::force_ratio, 2, 1, false},
    {"largest step, N", &Score::step, 2},
    {"lost, %", &Score::lost, 1},
    {"times through", &Score::through, 0},
    {"ticks felt in free air", &Score::in_free_air, 0},
    {"turned round", &Score::wrong_side, 0}};

// In metres around the cloud's origin, whatever its unit is.
any_cloud::Rendered touch(const HostileScene& scene, const Method& method) {
  const double metres = kSpacing / scene.spacing;
  PointCloud cloud = scene.cloud;
  const Eigen::Vector3d origin = cloud.origin;
  for (Eigen::Vector3f& p : cloud.positions) p *= static_cast<float>(metres);
  if (cloud.viewpoint) *cloud.viewpoint = metres * (*cloud.viewpoint - origin);
  cloud.origin.setZero();
  const std::unique_ptr<Rival> rival = method.make(method.scale);
  rival->show({nullptr, &cloud, spacing_of(cloud)});
  any_cloud::Rendered rendered;
  for (const HandTick& tick : scene.ticks) {
    const Eigen::Vector3d hip = metres * (tick.hand - origin);
    if (tick.starts) rival->reset(hip);
    const Step step = rival->step(hip);
    rendered.trace.force.push_back(step.force);
    rendered.trace.proxy.push_back(step.proxy / metres + origin);
    rendered.trace.fault.push_back(!step.force.allFinite());
    rendered.trace.microseconds.push_back(0);
  }
  return rendered;
}

}  // namespace

void print_clouds(const bench::SeedOptions& options, const std::vector<Method>& methods) {
  std::vector<std::string> names;
  std::vector<any_cloud::Touch> ways;
  for (const Method& method : methods) {
    const bool again = method.name == std::string_view("ours-points");  // `ours` without a frame
    if (method.needs != Needs::points || again) continue;
    names.emplace_back(method.name);
    ways.emplace_back([&](const HostileScene& scene) { return touch(scene, method); });
  }
  if (ways.empty()) throw Error("--methods: all of these need depth frames; name others");
  const Score refused{.lost = 100};  // a cloud that a method refuses is felt nowhere
  for (const any_cloud::Row& row : any_cloud::all_rows()) {
    if (!bench::is_wanted(row.name, options.names)) continue;
    std::vector<std::vector<Score>> seeds;
    for (int i = 0; i < options.seeds; ++i) {
      seeds.emplace_back();
      const auto seed = options.first_seed + static_cast<std::uint64_t>(i);
      for (const any_cloud::Result& result : any_cloud::run_row(row, seed, ways)) {
        seeds.back().push_back(result.score.value_or(refused));
      }
    }
    fmt::print("{}", method_table<Score>(row.name, names, seeds, kColumns));
    std::fflush(stdout);
  }
}

}  // namespace palpate::rivals
