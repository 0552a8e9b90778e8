#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/run/touch_statistics.hpp"
#include "apps/palpate/touch/touch.hpp"
#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

// Milliseconds of simulated time that every file is touched for: never less than a hand needs to
// come to the surface (a sweep of a lidar, 408).
int milliseconds() {
  return std::max(1000, test::effort(10'000));
}

std::string data_folder() {
  const char* folder = std::getenv("PALPATE_DATA");
  return folder != nullptr && fs::is_directory(folder) ? folder : "";
}

// Every k-th file where effort is small: then a test is to be quick, and not to be complete.
std::vector<fs::path> files_in(const fs::path& folder, std::initializer_list<const char*> endings) {
  std::vector<fs::path> files;
  const auto options = fs::directory_options::follow_directory_symlink;
  for (const auto& entry : fs::recursive_directory_iterator(folder, options)) {
    const std::string name = entry.path().string();
    const bool wanted = std::ranges::any_of(endings, [&](auto end) { return name.ends_with(end); });
    if (wanted && entry.is_regular_file()) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  const auto kept = static_cast<std::size_t>(test::effort(static_cast<int>(files.size())));
  const std::size_t stride = kept == 0 ? 1 : (files.size() + kept - 1) / kept;
  std::vector<fs::path> result;
  for (std::size_t i = 0; i < files.size(); i += stride) result.push_back(files[i]);
  return result;
}

// What the program needs to know of a depth image: its folder's sequence.json tells.
void describe_depth(const fs::path& file, ReadOptions& reading) {
  if (file.filename() == "TUM_depth.png") {
    reading.intrinsics = Pinhole{525, 525, 319.5, 239.5};
    reading.depth_unit = 1. / 5000;
    return;
  }
  std::ifstream stream(file.parent_path().parent_path() / "sequence.json");
  const auto facts = nlohmann::json::parse(stream);
  const auto value = [&](const char* key) { return facts.at(key).get<double>(); };
  reading.intrinsics = Pinhole{value("fx"), value("fy"), value("cx"), value("cy")};
  reading.depth_unit = value("depth_unit_m");
}

bool is_quiet(const ServoState& step) {
  return step.force.allFinite() && step.contact.proxy.allFinite() &&
         !has(step.contact.notes, ContactNote::fault);
}

// Touches as `palpate touch FILE --duration 10` does.
TouchStatistics statistics_of(const TouchPlan& plan) {
  LoadedScene loaded = load_sources(plan.sources, {.explored = true});
  std::vector<Hand> hands = open_hands(plan.devices, plan.motion, plan.time, nullptr);
  place_hands(hands, {plan.motion, plan.surface, plan.page}, {}, loaded.scene);
  Run run{plan.time,
          plan.page,
          plan.ros,
          loaded,
          hands,
          plan.surface.field,
          plan.surface.proxy_of(hands[0].stiffness)};
  TouchStatistics statistics;
  std::size_t bad = 0;
  run_simulated(run, [&](std::size_t, const ServoState& step) {
    statistics.add(step);
    if (!is_quiet(step)) ++bad;
  });
  EXPECT_EQ(bad, 0u) << "steps with a fault, or not finite";
  return statistics;
}

void expect_touched(const fs::path& file) {
  SCOPED_TRACE(file.string());
  TouchChoices choices;
  choices.sources = {file.string()};
  choices.plan.motion.duration = 1e-3 * milliseconds();
  if (file.extension() == ".png") describe_depth(file, choices.every_source.reading);
  const TouchStatistics statistics = statistics_of(plan_touch(CLI::App(), choices));
  EXPECT_GE(statistics.steps(), static_cast<std::size_t>(milliseconds()));
  EXPECT_GT(statistics.touching(), 0u);
}

void expect_all_touched(std::initializer_list<const char*> endings) {
  const std::vector<fs::path> files = files_in(data_folder(), endings);
  if (files.empty()) GTEST_SKIP() << "PALPATE_DATA holds no such file";
  for (const fs::path& file : files) expect_touched(file);
}

class EveryFile : public testing::Test {
 protected:
  void SetUp() override {
    if (data_folder().empty()) GTEST_SKIP() << "PALPATE_DATA names no folder of real data";
  }
};

TEST_F(EveryFile, MeshesAreTouchedWithoutAFault) {
  expect_all_touched({".ply", ".ply.gz"});
}

TEST_F(EveryFile, ScansAreTouchedWithoutAFault) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  expect_all_touched({".pcd", ".las", ".laz"});
}

TEST_F(EveryFile, DepthImagesAreTouchedWithoutAFault) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  expect_all_touched({".png"});
}

TEST_F(EveryFile, PackedSurveyOfTenMillionPointsIsTouchedWithoutAFault) {
  if (test::effort(10) < 10) GTEST_SKIP() << "too long where every test is to be quick";
  if (std::system("xz --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "xz is not installed";
  const Shell folder;
  const std::vector<fs::path> files = files_in(data_folder(), {".las.xz"});
  if (files.empty()) GTEST_SKIP() << "PALPATE_DATA holds no packed survey";
  for (const fs::path& packed : files) {
    const std::string unpacked = folder.path(packed.stem().string());
    const std::string command = fmt::format("xz -dc -T0 '{}' > '{}'", packed.string(), unpacked);
    if (std::system(command.c_str()) != 0) GTEST_SKIP() << "there is no room to unpack " << packed;
    expect_touched(unpacked);
  }
}

}  // namespace
}  // namespace palpate::app
