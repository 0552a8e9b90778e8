#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/report/log.hpp"
#include "apps/program.hpp"

namespace palpate::app {
namespace {

namespace fs = std::filesystem;

TEST(Output, AFullStandardOutputIsAnError) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  for (const std::string arguments : {"info plane.xyz", "--help", "cameras"}) {
    EXPECT_EQ(shell.run(arguments + " >/dev/full 2>said #").code, 1) << arguments;
    EXPECT_NE(shell.read("said").find("standard output: No space"), std::string::npos);
  }
}

TEST(Output, NothingThatIsNotOursMovesTheTerminal) {
  Shell shell;
  shell.write("\033[31mred.xyz", plane_xyz());
  shell.write("way.csv", "t,hip_x,hip_y,hip_z\n0,0,0,\033[31mRED\n");
  const Outcome info = shell.run("info '\033[31mred.xyz'");
  EXPECT_EQ(info.code, 0);
  EXPECT_EQ((info.out + info.err).find('\033'), std::string::npos);
  EXPECT_EQ(shell.run("touch synthetic:sphere --trajectory way.csv").err.find('\033'),
            std::string::npos);
}

TEST(Output, FileThatIsReadOrWrittenTwiceIsRefusedAndStaysAsItWas) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  fs::create_symlink("plane.xyz", shell.path("link.xyz"));
  fs::create_hard_link(shell.path("plane.xyz"), shell.path("twin.xyz"));
  for (const char* arguments :
       {"touch plane.xyz --log plane.xyz", "touch plane.xyz --json ./plane.xyz",
        "touch link.xyz --log plane.xyz", "touch plane.xyz --log link.xyz",
        "touch plane.xyz --picture twin.xyz", "touch plane.xyz --trajectory way.csv --log way.csv",
        "touch plane.xyz --log new.txt --json ./new.txt", "info plane.xyz --json plane.xyz",
        "info synthetic:sheet plane.xyz --picture a.png --json a-2.png",
        "info plane.xyz --picture twin.xyz"}) {
    const Outcome outcome = shell.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_NE(outcome.err.find("same file"), std::string::npos) << outcome.err;
    EXPECT_TRUE(shell.read("plane.xyz") == plane_xyz()) << arguments;
    EXPECT_TRUE(shell.read("way.csv") == press_and_slide()) << arguments;
  }
  EXPECT_FALSE(fs::exists(shell.path("new.txt")));
}

TEST(Output, FailedRunLeavesWhatWasThereAndNothingElse) {
  Shell shell;
  shell.write("broken.ply", "this is no cloud\n");
  for (const char* name : {"a.csv", "a.json", "a.png"}) shell.write(name, "of an earlier run");
  const std::size_t files = 1 + 3 + 3;  // and the shell's own three
  EXPECT_EQ(shell.run("touch broken.ply --log a.csv --json a.json --picture a.png").code, 1);
  for (const char* name : {"a.csv", "a.json", "a.png"}) {
    EXPECT_EQ(shell.read(name), "of an earlier run") << name;
  }
  const auto entries = fs::directory_iterator(fs::path(shell.path("")));
  EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(entries), end(entries))), files);
}

TEST(Output, NothingIsThereBeforeTheFirstByteNorAfterAFailure) {
  const Shell shell;
  const auto count = [&] {
    const auto entries = fs::directory_iterator(fs::path(shell.path("")));
    return std::distance(begin(entries), end(entries));
  };
  {
    OutputFile file(shell.path("a.csv"));
    EXPECT_EQ(count(), 0) << "a run that is ended now leaves nothing";
    file.write("1\n");
    EXPECT_FALSE(fs::exists(shell.path("a.csv")));
  }
  EXPECT_EQ(count(), 0);
  OutputFile file(shell.path("a.csv"));
  file.close();
  EXPECT_TRUE(fs::exists(shell.path("a.csv"))) << "an empty one is one";
}

// In simulated time; live_program_test.cpp has the one in real time.
TEST(Output, AnInterruptedRunLeavesItsLogAndReport) {
  Shell shell;
  const int status = std::system(
      fmt::format("cd '{}'; '{}' touch camera:simulated --simulated-time --duration 600 "
                  "--log log.csv --json run.json > out 2> err "
                  "& p=$!; until grep -qs touching err; do sleep 0.1; kill -0 $p || break; done; "
                  "kill -INT $p; wait $p",
                  shell.path("."), PALPATE_PROGRAM)
          .c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << shell.read("err");
  EXPECT_NE(shell.read("out").find("ended      by Ctrl-C"), std::string::npos);
  const nlohmann::json run = nlohmann::json::parse(shell.read("run.json"));
  EXPECT_EQ(run["interrupted"], true);
  EXPECT_LT(run["steps"], 600'000);
  EXPECT_EQ(columns(shell.read("log.csv"))["t"].size(), run["steps"]);
  for (const auto& entry : fs::directory_iterator(fs::path(shell.path("")))) {
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  }
}

TEST(Output, ARunThatIsEndedAtOnceLeavesWhatItLoggedBesideWhatWasThere) {
  Shell shell;
  shell.write("log.csv", "of an earlier run");
  shell.write("log.csv.part", "of one that was ended");
  const int status = std::system(
      fmt::format("cd '{}'; '{}' touch camera:simulated --simulated-time --duration 600 "
                  "--log log.csv --json run.json > /dev/null 2> err "
                  "& p=$!; until test -s log.csv.part-2; do sleep 0.1; kill -0 $p || break; done; "
                  "kill -KILL $p; wait $p",
                  shell.path("."), PALPATE_PROGRAM)
          .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 128 + SIGKILL) << shell.read("err");
  EXPECT_EQ(shell.read("log.csv"), "of an earlier run");
  EXPECT_EQ(shell.read("log.csv.part"), "of one that was ended");
  EXPECT_GT(columns(shell.read("log.csv.part-2"))["t"].size(), 100u);
  const auto entries = fs::directory_iterator(fs::path(shell.path("")));
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 4) << "these and what it said";
}

// A full disk, as far as a file can know: it may have so many bytes.
constexpr const char* kRoom = "prlimit --fsize=400000 env --ignore-signal=XFSZ";

TEST(Output, TheLogOfARunThatFailsStaysBesideItsPlace) {
  const Shell shell;
  {
    TouchLog log(shell.path("log.csv"));
    log.add({}, {}, 1);
  }
  EXPECT_EQ(columns(shell.read("log.csv.part"))["t"].size(), 1u);
  EXPECT_FALSE(fs::exists(shell.path("log.csv")));
}

TEST(Output, AFullDiskEndsTheLogAndNotTheRunAndKeepsWholeRows) {
  Shell shell;
  shell.write("log.csv", "of an earlier run");
  const Outcome outcome = shell.run(
      "touch camera:simulated --no-view --duration 3 --log log.csv "
      "--json run.json",
      "", kRoom);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("log.csv.part; the run goes on\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("log        log.csv cannot"), std::string::npos) << outcome.out;
  const Json run = Json::parse(shell.read("run.json"));
  EXPECT_GE(run["real_s"], 2.9);
  EXPECT_NE(run["log_problem"], "");
  EXPECT_EQ(shell.read("log.csv"), "of an earlier run");
  const std::string kept = shell.read("log.csv.part");
  EXPECT_GT(kept.size(), 250'000u);
  EXPECT_EQ(kept.back(), '\n');
  for (const auto& column : columns(kept)) {
    EXPECT_EQ(column.second.size(), columns(kept)["t"].size()) << column.first;
  }
}

TEST(Output, AFullDiskEndsTheRecordingAndNotTheRunWhichEndsWithAnError) {
  Shell shell;
  const Outcome outcome = shell.run(
      "touch synthetic:sheet --device simulated --simulated-time --duration 7 --record r.mcap", "",
      kRoom);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("7 001 in 7.00 s"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("r.mcap"), std::string::npos) << outcome.err;
  EXPECT_EQ(shell.run("bag info r.mcap").code, 0);
  EXPECT_EQ(shell.run("replay r.mcap").code, 0) << "as far as it goes";
}

TEST(Output, WhatAnotherProgramWritesComesToItsPlace) {
  const Shell shell;
  OutputFile file(shell.path("a.txt"));
  ASSERT_EQ(std::system(fmt::format("echo written > {}", file.growing()).c_str()), 0);
  EXPECT_FALSE(fs::exists(shell.path("a.txt")));
  file.close();
  EXPECT_EQ(shell.read("a.txt"), "written\n");
}

TEST(Output, LinksAndDevicesAreWrittenThrough) {
  Shell shell;
  shell.write("real.csv", "old");
  fs::create_symlink("real.csv", shell.path("link.csv"));
  const Outcome outcome =
      shell.run("touch synthetic:sheet --duration 0.1 --log link.csv --json /dev/null");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::is_symlink(shell.path("link.csv")));
  EXPECT_EQ(shell.read("real.csv").find("t,hip_x"), 0u);
}

// Folders that may not be entered are like this, too; the superuser may enter all.
TEST(Output, WhatCannotBeLookedForIsToldInWords) {
  Shell shell;
  const std::string name(300, 'a');
  shell.write("x.xyz", plane_xyz());
  for (const std::string& command :
       {"touch " + name + ".ply", "touch " + name + ".oni", "bag recover x.mcap " + name + ".mcap",
        "align x.xyz x.xyz --output " + name + ".toml", "tile x.xyz --out " + name,
        "touch x.xyz --duration 0.1 --record " + name + ".mcap",
        "touch x.xyz --duration 0.1 --log " + name + ".csv"}) {
    const Outcome outcome = shell.run(command);
    EXPECT_EQ(outcome.code, 1) << command;
    EXPECT_EQ(outcome.err.find("filesystem error"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("palpate: "), std::string::npos) << command;
  }
}

TEST(Output, ProtectedFileIsNotReplaced) {
  if (access("/", W_OK) == 0) GTEST_SKIP() << "the superuser may write everything";
  Shell shell;
  shell.write("kept.csv", "kept");
  fs::permissions(shell.path("kept.csv"), fs::perms::owner_read);
  EXPECT_EQ(shell.run("touch synthetic:sheet --duration 0.1 --log kept.csv").code, 1);
  EXPECT_EQ(shell.read("kept.csv"), "kept");
}

}  // namespace
}  // namespace palpate::app
