#include "sensor/frame_files.hpp"

#include <gtest/gtest.h>

#include "sensor/folder.hpp"

namespace palpate::sensor {
namespace {

using Names = std::vector<std::string>;

// Writes files of these names and tells in which order they are frames.
Names order_of(const Names& names) {
  const Folder folder;
  for (const std::string& name : names) folder.write(name, "");
  Names found;
  for (const auto& frame : frames_in(folder.path(), "")) found.push_back(frame.filename().string());
  return found;
}

TEST(FrameFiles, CountAsTheNumbersInTheirNamesDo) {
  const Names wanted{"f0.ply", "f1.ply", "f2.ply", "f10.ply", "f11.ply", "f100.ply"};
  EXPECT_EQ(order_of({"f10.ply", "f100.ply", "f2.ply", "f1.ply", "f11.ply", "f0.ply"}), wanted);
  const Names images{"1_9.png", "2_1.png", "002_10.png", "10_1.png"};
  EXPECT_EQ(order_of({"10_1.png", "002_10.png", "2_1.png", "1_9.png"}), images);
  const Names padded{"007.pgm", "7.pgm", "08.pgm"};
  EXPECT_EQ(order_of({"7.pgm", "08.pgm", "007.pgm"}), padded) << "equal numbers by their text";
  const Names long_numbers{"9.png", "1000000000000000000000001.png",
                           "1000000000000000000000002.png"};
  EXPECT_EQ(order_of({long_numbers[2], long_numbers[0], long_numbers[1]}), long_numbers);
}

TEST(FrameFiles, TakeWhatFollowsAPointForAFraction) {
  const Names times{"9.75.png", "10.25.png", "10.5.png", "10.625.png"};
  EXPECT_EQ(order_of({"10.5.png", "10.625.png", "9.75.png", "10.25.png"}), times);
}

TEST(FrameFiles, LeaveColourPicturesBesideDepthImagesOut) {
  const Names depth{"frame-000000.depth.png", "frame-000001.depth.png"};
  EXPECT_EQ(order_of({"frame-000000.color.png", depth[0], "frame-000001.color.png", depth[1],
                      "frame-000000.pose.txt"}),
            depth);
  const Names unnamed{"a.png", "b.png"};
  EXPECT_EQ(order_of(unnamed), unnamed);
}

}  // namespace
}  // namespace palpate::sensor
