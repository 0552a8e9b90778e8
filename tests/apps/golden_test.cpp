// What the program says and does stays as it is unless somebody means it to change: its help, what
// it reports, and every force of some runs. PALPATE_GOLDEN=write writes tests/apps/golden instead.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

bool writes() {
  const char* wish = std::getenv("PALPATE_GOLDEN");
  return wish != nullptr && std::string(wish) == "write";
}

std::filesystem::path golden(const std::string& name) {
  return std::filesystem::path(PALPATE_GOLDEN_FILES) / name;
}

void expect_golden(const std::string& name, const std::string& text) {
  if (writes()) {
    std::ofstream(golden(name)) << text;
    return;
  }
  std::ifstream file(golden(name));
  ASSERT_TRUE(file) << golden(name) << " is missing; PALPATE_GOLDEN=write writes it";
  std::stringstream expected;
  expected << file.rdbuf();
  EXPECT_EQ(text, expected.str()) << name << ": if that is meant, PALPATE_GOLDEN=write accepts it";
}

// Without numbers, their units, and what of the machine comes through.
std::string masked(std::string text) {
  static const std::regex kNumber(
      R"(-?\d[\d ]*(\.\d+)?(e-?\d+)?( ?(ns|us|ms|s|nm|um|mm|m|uN|mN|N|uJ|mJ|J)\b)?)");
  static const std::regex kPath(R"(/[^ ,:]*/)");
  text = std::regex_replace(text, kPath, "DIR/");
  return std::regex_replace(text, kNumber, "#");
}

// The same of a report's values.
std::string outline(const nlohmann::ordered_json& json, const std::string& indent = "") {
  std::string text;
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      text.append("\n").append(indent).append(key).append(":").append(
          outline(value, indent + "  "));
    }
    return text;
  }
  if (json.is_array()) {
    for (const auto& value : json) text += "\n" + indent + "-" + outline(value, indent + "  ");
    return text;
  }
  if (json.is_string()) return " " + masked(json.get<std::string>());
  return json.is_number() ? " #" : " " + json.dump();
}

// FNV-1a.
std::string hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

// Other compilers and libraries may round otherwise.
constexpr bool kSameArithmetic = PALPATE_GOLDEN_ARITHMETIC;

struct GoldenRun {
  const char* name;
  const char* arguments;  // without --log and --json
  bool large = false;     // a cloud that a slow build prepares for half a minute
};

constexpr GoldenRun kRuns[] = {
    {"torus", "touch synthetic:torus --duration 1"},
    {"room", "touch synthetic:room --duration 1 --friction-static 0.5 --friction-dynamic 0.4",
     true},
    {"table_paper", "touch synthetic:table --preset paper --duration 1"},
    {"rabbit_metaball", "touch synthetic:rabbit --field metaball --duration 1", true},
    {"two_clouds",
     "touch left=plane.xyz right=plane.xyz --pose right=0.05,0,0,0,0,0,1 --duration 1"},
    {"trajectory", "touch plane.xyz --trajectory way.csv"},
    {"setup", "touch --setup scene.toml --duration 1"},
};

class Golden : public testing::TestWithParam<GoldenRun> {};

TEST_P(Golden, RunSaysAndDoesWhatItDid) {
  const GoldenRun& run = GetParam();
  if (run.large && test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  shell.write("scene.toml", R"([[source]]
name = "table"
from = "synthetic:table"
[[source]]
name = "ball"
from = "synthetic:sphere"
pose = [0.1, 0.0, 0.05, 0.0, 0.0, 0.0, 1.0]
[surface]
radius = 0.008
)");
  const Outcome outcome =
      shell.run(std::string(run.arguments) + " --log log.csv --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_golden(std::string(run.name) + ".txt", masked(outcome.out));
  expect_golden(std::string(run.name) + ".json.txt",
                outline(nlohmann::ordered_json::parse(shell.read("report.json"))) + "\n");
  if (!kSameArithmetic) GTEST_SKIP() << "forces were recorded with another compiler";
  expect_golden(std::string(run.name) + ".hash", hash_of(without_times(shell, "log.csv")) + "\n");
}

INSTANTIATE_TEST_SUITE_P(Of, Golden, testing::ValuesIn(kRuns),
                         [](const auto& run) { return std::string(run.param.name); });

class GoldenHelp : public testing::TestWithParam<const char*> {};

TEST_P(GoldenHelp, SaysWhatItDid) {
  Shell shell;
  const Outcome outcome = shell.run(std::string(GetParam()) + " --help");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string command = GetParam();
  expect_golden("help" + (command.empty() ? "" : "_" + command) + ".txt", outcome.out);
}

INSTANTIATE_TEST_SUITE_P(Of, GoldenHelp,
                         testing::Values("", "touch", "align", "info", "bag", "cameras", "doctor",
                                         "devices", "paper", "demo", "replay", "tile", "zwidth"),
                         [](const auto& command) {
                           return *command.param ? std::string(command.param) : "palpate";
                         });

}  // namespace
}  // namespace palpate::app
