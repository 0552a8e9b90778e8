#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "apps/palpate/touch/touch.hpp"
#include "apps/setup_parsed.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> sequences() {
  const char* folder = std::getenv("PALPATE_DATA");
  std::vector<fs::path> found;
  if (folder == nullptr || !fs::is_directory(folder)) return found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (fs::exists(entry.path() / "sequence.json")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

struct Felt {
  std::size_t steps = 0;
  std::size_t touching = 0;
  std::size_t bad = 0;
  std::size_t without_surface = 0;
};

// The hand goes along `way` or, where that is empty, explores what `seen` shows.
Felt play(const TouchPlan& plan, const Trajectory& way, const Scene& seen, LoadedScene& loaded) {
  std::vector<Hand> hands = open_hands(plan.devices, plan.motion, plan.time, nullptr);
  place_hands(hands, {plan.motion, plan.surface, plan.page}, way, seen);
  begin_run(loaded, {});
  Run run{plan.time,
          plan.page,
          plan.ros,
          loaded,
          hands,
          plan.surface.field,
          plan.surface.proxy_of(hands[0].stiffness)};
  Felt result;
  run_simulated(run, [&](std::size_t, const ServoState& step) {
    const Contact& contact = step.contact;
    const bool quiet = step.force.allFinite() && contact.proxy.allFinite() &&
                       !has(contact.notes, ContactNote::fault);
    ++result.steps;
    result.bad += quiet ? 0 : 1;
    result.touching += contact.touching ? 1 : 0;
    result.without_surface += has(step.field_notes, FieldNote::no_surface) ? 1 : 0;
  });
  return result;
}

// Far away from everything for some seconds.
Trajectory aside(double seconds) {
  Trajectory way;
  for (int i = 0; i <= static_cast<int>(1000 * seconds); ++i) {
    way.push_back({1e-3 * i, Eigen::Vector3d(0, 0, -100)});
  }
  return way;
}

TEST(EverySequence, PlaysThroughAndIsTouchedWithoutAFault) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  if (sequences().empty()) GTEST_SKIP() << "PALPATE_DATA names no folder with sequences";
  for (const fs::path& folder : sequences()) {
    SCOPED_TRACE(folder.string());
    const double duration = 1e-3 * test::effort(3000);
    const TouchPlan plan = planned(
        fmt::format("sequence:{} --simulated-time --duration {}", folder.string(), duration));
    // The first run shows what there is to touch at the end, the second one touches it.
    LoadedScene watched = load_sources(plan.sources, {});
    EXPECT_EQ(play(plan, aside(duration), watched.scene, watched).bad, 0u);
    LoadedScene loaded = load_sources(plan.sources, {});
    const Felt felt = play(plan, {}, watched.scene, loaded);
    EXPECT_EQ(felt.bad, 0u) << "steps with a fault, or not finite";
    // A hand that has a tenth of the time is still on its way.
    if (test::effort(10) == 10) {
      EXPECT_GT(felt.touching, felt.steps / 100);
    }
    EXPECT_LE(felt.without_surface, 10u) << "before the first frame is touchable";
    const StreamState& state = loaded.sources[0].feed.state;
    EXPECT_GT(state.touchable, 2u);
    EXPECT_EQ(state.failures + state.drops.garbage, 0u) << state.problem;
  }
}

}  // namespace
}  // namespace palpate::app
