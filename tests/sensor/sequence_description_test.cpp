#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "sensor/sequence.hpp"

namespace palpate::sensor {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    (void)parse_description(text, "a.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// The least that there must be, and more fields.
std::string with(const std::string& fields) {
  return R"({"fx": 500, "fy": 510, "cx": 320, "cy": 240)" + fields + "}";
}

TEST(SequenceDescription, HasDefaults) {
  const SequenceDescription sequence = parse_description(with(""), "a.json");
  EXPECT_EQ(sequence.camera.width, 0);
  EXPECT_EQ(sequence.camera.pinhole.fy, 510);
  EXPECT_TRUE(sequence.camera.distortion.none());
  EXPECT_EQ(sequence.depth_unit, 1e-3);
  EXPECT_FALSE(sequence.rate);
  EXPECT_FALSE(sequence.swapped);
  EXPECT_TRUE(sequence.poses.empty());
  EXPECT_TRUE(sequence.T_posed_sensor.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(SequenceDescription, TellsEveryField) {
  const SequenceDescription sequence =
      parse_description(with(R"(, "width": 640, "height": 480, "distortion": [0.1, 0.2, 0.3],
      "depth_unit_m": 0.0002, "fps": 15, "invalid": [0, 7, 65535, 55669], "images": "d",
      "frames": "list.txt", "stamps": [0, 0.5], "pose": "poses.log: of the colour camera",
      "pose_direction": "world_to_camera", "T_pose_camera": [1, 2, 3, 0, 0, 1, 0],
      "byte_order": "little", "static_camera": false, "intrinsics_note": "guessed")"),
                        "a.json");
  EXPECT_EQ(sequence.camera.width, 640);
  EXPECT_EQ(sequence.camera.height, 480);
  EXPECT_EQ(sequence.camera.distortion.k2, 0.2);
  EXPECT_EQ(sequence.camera.distortion.p1, 0.3);
  EXPECT_EQ(sequence.camera.distortion.k3, 0);
  EXPECT_EQ(sequence.depth_unit, 2e-4);
  EXPECT_EQ(sequence.rate, 15);
  EXPECT_THAT(sequence.invalid, ElementsAre(7, 55669));
  EXPECT_EQ(sequence.images, "d");
  EXPECT_EQ(sequence.frames, "list.txt");
  EXPECT_THAT(sequence.stamps, ElementsAre(0, 0.5));
  EXPECT_EQ(sequence.poses, "poses.log");
  EXPECT_TRUE(sequence.world_to_camera);
  EXPECT_TRUE(sequence.swapped);
  EXPECT_TRUE(
      (sequence.T_posed_sensor * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 2, 3)));
}

TEST(SequenceDescription, RefusesWhatItCannotUnderstand) {
  EXPECT_THAT(refusal("{"), AllOf(HasSubstr("a.json"), HasSubstr("not valid JSON")));
  EXPECT_THAT(refusal("[1]"), HasSubstr("not an object"));
  EXPECT_THAT(refusal(R"({"fy": 4})"), HasSubstr("\"fx\" is missing"));
  EXPECT_THAT(refusal(with(R"(, "fbs": 3)")), HasSubstr("unknown field \"fbs\""));
  EXPECT_THAT(refusal(with(R"(, "fps": "fast")")), HasSubstr("\"fps\" is \"fast\""));
  EXPECT_THAT(refusal(with(R"(, "fps": 0)")), HasSubstr("\"fps\" is 0"));
  EXPECT_THAT(refusal(with(R"(, "fps": 1e999)")), HasSubstr("a.json"));
  EXPECT_THAT(refusal(with(R"(, "width": -1)")), HasSubstr("\"width\" is -1"));
  EXPECT_THAT(refusal(with(R"(, "depth_unit_m": 0)")), HasSubstr("metres per depth unit"));
  EXPECT_THAT(refusal(with(R"(, "invalid": [70000])")), HasSubstr("0 to 65535"));
  EXPECT_THAT(refusal(with(R"(, "invalid": [0.5])")), HasSubstr("0 to 65535"));
  EXPECT_THAT(refusal(with(R"(, "distortion": [1, 2, 3, 4, 5, 6])")), HasSubstr("Brown"));
  EXPECT_THAT(refusal(with(R"(, "distortion": ["a"])")), HasSubstr("Brown"));
  EXPECT_THAT(refusal(with(R"(, "pose": 3)")), HasSubstr("name of a file"));
  EXPECT_THAT(refusal(with(R"(, "byte_order": "middle")")), HasSubstr("\"big\" or \"little\""));
  EXPECT_THAT(refusal(with(R"(, "T_pose_camera": [1, 2, 3])")), HasSubstr("qx"));
  EXPECT_THAT(refusal(with(R"(, "T_pose_camera": [1, 2, 3, 0, 0, 0, 0])")),
              HasSubstr("unit quaternion"));
}

}  // namespace
}  // namespace palpate::sensor
