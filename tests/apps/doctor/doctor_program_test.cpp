#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/palpate/doctor/system.hpp"
#include "apps/program.hpp"

namespace palpate::app {
namespace {

// OpenNI2 is not ours: sanitizers are not to mind its locks, nor what its drivers leave behind.
constexpr const char* kForeign = "env ASAN_OPTIONS=detect_leaks=0";
// Whoever runs the tests: without rights to anything.
constexpr const char* kNoRights = "prlimit --rtprio=0:0 --memlock=65536:65536";
constexpr const char* kNobody = "setpriv --reuid=65534 --regid=65534 --clear-groups";

nlohmann::json examined(Shell& shell, const std::string& before) {
  const Outcome outcome = shell.run("doctor --jitter 0 --json -", "", before);
  EXPECT_NE(outcome.err.find("kernel"), std::string::npos) << outcome.err;
  const auto findings = nlohmann::json::parse(outcome.out);
  int code = 0;
  for (const auto& finding : findings) {
    EXPECT_EQ(finding["severity"] == "good", finding["remedy"] == "") << finding;
    if (finding["severity"] == "problem") code = 1;
    if (finding["severity"] == "warning" && code == 0) code = 3;
  }
  EXPECT_EQ(outcome.code, code) << outcome.out;
  return findings;
}

nlohmann::json about(const std::string& looked_at, const nlohmann::json& findings) {
  for (const auto& finding : findings) {
    if (finding["looked_at"] == looked_at) return finding;
  }
  ADD_FAILURE() << "nothing on " << looked_at;
  return {{"severity", ""}, {"words", ""}, {"remedy", ""}};
}

std::string with_libraries(const Shell& shell) {
  return fmt::format("env ASAN_OPTIONS=detect_leaks=0 LD_LIBRARY_PATH='{}'", shell.path(""));
}

TEST(Doctor, ExaminesThisMachine) {
  Shell shell;
  const auto findings = examined(shell, kForeign);
  EXPECT_EQ(about("palpate's files", findings)["severity"], "good");
  EXPECT_NE(about("preemption", findings)["words"], "");
}

TEST(Doctor, MeasuresJitterAndPrintsAHistogram) {
  Shell shell;
  const Outcome outcome = shell.run("doctor --jitter 0.1 --json findings.json", "", kForeign);
  EXPECT_NE(outcome.out.find("jitter at 1 kHz"), std::string::npos) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("#"), std::string::npos) << outcome.out;
  EXPECT_FALSE(about("jitter at 1 kHz", nlohmann::json::parse(shell.read("findings.json")))["lines"]
                   .empty());
}

TEST(Doctor, TellsAnOrdinaryUserHowToGetRights) {
  const bool root = geteuid() == 0;
  const std::string user = root ? std::string(kNobody) + " " + kNoRights : kNoRights;
  if (std::system(fmt::format("{} test -x '{}'", user, PALPATE_PROGRAM).c_str()) != 0) {
    GTEST_SKIP() << "nobody else may run " << PALPATE_PROGRAM;
  }
  Shell shell;
  const auto findings = examined(shell, std::string(kForeign) + " " + user);
  const auto priority = about("real-time priority 80 (SCHED_FIFO)", findings);
  EXPECT_EQ(priority["severity"], "warning");
  EXPECT_NE(priority["remedy"], "");
  EXPECT_EQ(about("memory locked (mlockall)", findings)["severity"], "warning");
  EXPECT_EQ(about("limits", findings)["words"].get<std::string>().find("rtprio 0, memlock 65536"),
            0u);
}

TEST(Doctor, LoadsVendorsLibrariesAndSurvivesThoseThatDoNot) {
  Shell shell;
  std::filesystem::copy_file(PALPATE_FAKE_VENDOR, shell.path("libdhd.so.3"));
  std::filesystem::copy_file(PALPATE_FAKE_CRASH, shell.path("libdrd.so.3"));
  shell.write("libHD.so", "no library at all");
  const auto findings = examined(shell, with_libraries(shell));
  EXPECT_EQ(about("libdhd.so.3", findings)["words"], "loaded, version 3.17.6.0");
  EXPECT_NE(about("libdrd.so.3", findings)["words"].get<std::string>().find("crashes (signal 6)"),
            std::string::npos);
  EXPECT_EQ(about("libHD.so", findings)["severity"], "warning");
}

TEST(Doctor, TellsTheVersionThatAFileIsNamedAfter) {
  Shell shell;
  std::filesystem::copy_file(PALPATE_FAKE_HD, shell.path("libHD.so.3.4.0"));
  std::filesystem::create_symlink("libHD.so.3.4.0", shell.path("libHD.so"));
  EXPECT_EQ(about("libHD.so", examined(shell, with_libraries(shell)))["words"],
            "loaded, version 3.4.0");
}

TEST(Doctor, WarnsOfALocaleThatDoesNotExist) {
  Shell shell;
  const auto findings = examined(shell, std::string(kForeign) + " LC_ALL=xx_XX.UTF-8");
  EXPECT_NE(about("locale", findings)["words"].get<std::string>().find("LC_ALL=xx_XX.UTF-8"),
            std::string::npos);
}

TEST(Doctor, RefusesTimesThatAreNone) {
  Shell shell;
  const Outcome outcome = shell.run("doctor --jitter -1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("from 0 to 3600 s"), std::string::npos) << outcome.err;
  EXPECT_NE(shell.run("doctor --help").out.find("3 warnings"), std::string::npos);
}

TEST(DoctorLibraryTrial, TellsAbsentFromBroken) {
  using doctor::LibraryTrial;
  EXPECT_EQ(doctor::try_library("libthat-is-not-there.so").outcome, LibraryTrial::Outcome::absent);
  const LibraryTrial loaded = doctor::try_library(PALPATE_FAKE_VENDOR);
  EXPECT_EQ(loaded.outcome, LibraryTrial::Outcome::loaded);
  EXPECT_EQ(loaded.words, "3.17.6.0");
  EXPECT_EQ(doctor::try_library(PALPATE_FAKE_CRASH).outcome, LibraryTrial::Outcome::broken);
}

}  // namespace
}  // namespace palpate::app
