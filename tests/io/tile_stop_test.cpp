// The writing of a store that is stopped, in whatever way, goes on to the same bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>

#include "io/tile_inputs.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using io::tile::tile;
using io::tile::TileOptions;
using test::Folder;
using test::read_store;
using testing::HasSubstr;

struct Stop {};

TEST(TileStop, ARunThatIsStoppedAnywhereGoesOnToTheSameBytes) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(60000)));
  TileOptions options = small_options();
  options.chunk_points = 12000;
  int calls = 0;
  options.progress = [&](const std::string&, double) { ++calls; };
  tile({folder / "a.las"}, folder / "whole", options);
  ASSERT_GT(calls, 10);
  Random random(3);
  int stops = 0;
  while (stops < 20) {
    const fs::path out = folder / "out";
    bool done = false;
    while (!done) {  // may be stopped several times
      int left = 1 + static_cast<int>(random.uniform() * calls);
      options.progress = [&](const std::string&, double) {
        if (--left == 0) throw Stop{};
      };
      try {
        tile({folder / "a.las"}, out, options);
        done = true;
      } catch (const Stop&) {
        ++stops;
      }
    }
    ASSERT_EQ(bytes_of(out), bytes_of(folder / "whole")) << stops;
    EXPECT_FALSE(fs::exists(out / "unfinished"));
    fs::remove_all(out);
  }
}

TEST(TileStop, ThereIsNoMetadataBeforeTheStoreIsWhole) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(5000)));
  TileOptions options = small_options();
  int seen = 0;
  options.progress = [&](const std::string& step, double done) {
    if (step == "finishing" && done == 1) return;
    ++seen;
    EXPECT_FALSE(fs::exists(folder / "out/metadata.json")) << step << done;
  };
  tile({folder / "a.las"}, folder / "out", options);
  EXPECT_GT(seen, 5);
}

TEST(TileStop, ACompleteStoreIsReplacedByForceAlone) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(500)));
  folder.write("b.las", las_bytes(2, 2, ground(700)));
  tile({folder / "a.las"}, folder / "out");
  EXPECT_EQ(tile_refusal({folder / "b.las"}, folder / "out"),
            (folder / "out") + " is complete; --force replaces it.");
  EXPECT_EQ(read_store(folder / "out").points().size(), 500U);
  TileOptions options;
  options.force = true;
  options.progress = [](const std::string& step, double) {
    if (step == "building the octree") throw Stop{};
  };
  EXPECT_THROW(tile({folder / "b.las"}, folder / "out", options), Stop);
  EXPECT_EQ(read_store(folder / "out").points().size(), 500U) << "until the other is whole";
  options.progress = {};
  tile({folder / "b.las"}, folder / "out", options);
  EXPECT_EQ(read_store(folder / "out").points().size(), 700U);
}

TEST(TileStop, GoingOnWithOtherInputsOrOptionsIsRefused) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(5000)));
  folder.write("b.las", las_bytes(2, 2, ground(5000)));
  TileOptions options = small_options();
  options.progress = [](const std::string& step, double) {
    if (step == "building the octree") throw Stop{};
  };
  EXPECT_THROW(tile({folder / "a.las"}, folder / "out", options), Stop);
  EXPECT_THAT(tile_refusal({folder / "b.las"}, folder / "out"),
              HasSubstr("was begun with other inputs: " + (folder / "a.las")));
  options = small_options();
  options.reading.scale = 2;
  EXPECT_THAT(tile_refusal({folder / "a.las"}, folder / "out", options),
              HasSubstr("other options, or its inputs have changed"));
  fs::last_write_time(folder / "a.las", fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_THAT(tile_refusal({folder / "a.las"}, folder / "out"), HasSubstr("have changed since"));
  options.force = true;
  EXPECT_EQ(tile_refusal({folder / "a.las"}, folder / "out", options), "no error");
}

TEST(TileStop, AnotherJobThatIsUnfinishedIsToldAndForceStartsAnew) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(500)));
  folder.write("out/unfinished/job.txt", "b.las");
  EXPECT_THAT(tile_refusal({folder / "a.las"}, folder / "out"),
              HasSubstr("with other inputs: b.las. Give these, or start anew with --force"));
  TileOptions options;
  options.force = true;
  EXPECT_EQ(tile_refusal({folder / "a.las"}, folder / "out", options), "no error");
}

TEST(TileStop, FilesOfOthersInAFolderOfThatNameStay) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(500)));
  folder.write("out/unfinished/notes/a.txt", "mine");
  TileOptions options;
  for (const bool force : {false, true}) {
    options.force = force;
    EXPECT_THAT(tile_refusal({folder / "a.las"}, folder / "out", options),
                HasSubstr("unfinished/notes: palpate did not write it. Name another folder."));
    EXPECT_TRUE(fs::exists(folder / "out/unfinished/notes/a.txt"));
  }
}

TEST(TileStop, TooLittleSpaceIsToldBeforeAnyIsTaken) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(5000)));
  TileOptions options = small_options();
  options.free_bytes = [](const fs::path&) { return std::uint64_t{12'000'000}; };
  EXPECT_THAT(tile_refusal({folder / "a.las"}, folder / "out", options),
              HasSubstr("tile needs 0.0672 GB in " + (folder / "out") + ", 0.012 GB are free"));
  options.free_bytes = {};
  EXPECT_EQ(tile_refusal({folder / "a.las"}, folder / "out", options), "no error");
}

TEST(TileStop, ADiskThatBecomesFullIsToldAndTheNextRunGoesOn) {
  const Folder folder;
  folder.write("a.las", las_bytes(2, 2, ground(20000)));
  tile({folder / "a.las"}, folder / "whole", small_options());
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto earlier = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{200'000, before.rlim_max};  // of 400 kB
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string told = tile_refusal({folder / "a.las"}, folder / "out");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, earlier);
  EXPECT_THAT(told, HasSubstr("it cannot be written (File too large)"));
  EXPECT_EQ(tile_refusal({folder / "a.las"}, folder / "out"), "no error");
  EXPECT_EQ(bytes_of(folder / "out"), bytes_of(folder / "whole"));
}

}  // namespace
}  // namespace palpate
