// Recordings some of whose steps and frames are damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "apps/playing.hpp"
#include "apps/program.hpp"
#include "session/shown_run.hpp"
#include "support/folder.hpp"
#include "support/rewritten_bag.hpp"

namespace palpate::app {
namespace {

// A simulated camera sees a hand that touches.
class DamagedRecordingTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    Shell shell;
    ASSERT_EQ(record_camera(shell, 2).code, 0);
    file = shell.read("run.mcap");
  }
  void SetUp() override { folder.write("whole.mcap", file); }

  // The file with a pose of so many numbers of a frame, or of all.
  [[nodiscard]] std::string with_pose(int frame, std::size_t numbers) const {
    const auto change = [&](message::FrameUse& use) { use.pose.resize(numbers); };
    folder.write("damaged.mcap", test::rewritten<message::FrameUse>(file, "/use", frame, change));
    return folder / "damaged.mcap";
  }

  inline static std::string file;
  test::Folder folder;
};

TEST_F(DamagedRecordingTest, ADamagedStepPausesAPlayerWhichShowsWhatIsSoughtLater) {
  folder.write("damaged.mcap",
               test::rewritten<message::Tick>(
                   file, "/tick", 800, [](message::Tick& tick) { tick.time = std::nan(""); }));
  const std::string path = folder / "damaged.mcap";
  Playing playing(path);
  Playing::wait([&] { return playing.complained().size() == 1; });
  playing.line.seek(0.7);
  playing.line.play(true, 1);
  Playing::wait([&] { return playing.complained().size() == 2; });
  EXPECT_FALSE(playing.line.moment().playing);
  for (const std::string& why : playing.complained()) {
    EXPECT_EQ(why, path + ": a step is damaged: it has no time");
  }
  const auto shown = [&] { return playing.player.servos()[0]->state().time; };
  const double before = shown();
  playing.line.seek(1.5);
  Playing::wait([&] { return shown() > before + 0.6; });
  playing.line.seek(0.7);
  playing.line.play(true, 1);
  Playing::wait([&] { return playing.complained().size() == 3; });
  playing.line.play(true, 1);
  Playing::wait([&] { return shown() > before + 0.1; });
}

TEST_F(DamagedRecordingTest, TheFrameBeforeADamagedOneIsShownAndThoseBehindIt) {
  const session::Recording whole(folder / "whole.mcap");
  std::vector<double> starts;
  session::Recording::Frames frames(whole, 0);
  while (const auto frame = frames.next()) starts.push_back(frame->use.start);
  constexpr int kDamaged = 20;
  ASSERT_GT(starts.size(), kDamaged + 3U);
  const session::Recording damaged(with_pose(kDamaged, 3));
  Scene scene;
  session::ShownSource source(damaged, 0, scene);
  Scene reference_scene;
  session::ShownSource reference(whole, 0, reference_scene);
  const auto expect_same = [&](double time) {
    reference.show(time);
    const auto expected = reference_scene.source(0).points();
    const auto shown = scene.source(0).points();
    ASSERT_TRUE(expected && shown);
    EXPECT_TRUE(std::ranges::equal(shown->grid.points(), expected->grid.points())) << time;
  };
  source.show(starts[kDamaged - 3]);
  expect_same(starts[kDamaged - 3]);
  const double before = starts[kDamaged - 1] + 1e-6;
  EXPECT_THROW(source.show(before), Error);
  expect_same(before);
  const double behind = starts[kDamaged + 1] + 1e-6;
  source.show(behind);
  expect_same(behind);
}

TEST_F(DamagedRecordingTest, AFrameWhosePoseIsNoneIsRefusedInWords) {
  const std::string path = with_pose(-1, 3);
  try {
    const Playback playback(path);
    ADD_FAILURE() << "it plays";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), path + ": a frame is damaged: its pose has 3 numbers, not 12");
  }
}

}  // namespace
}  // namespace palpate::app
