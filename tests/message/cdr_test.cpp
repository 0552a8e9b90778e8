#include "message/cdr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "message/display_types.hpp"
#include "message/schema.hpp"

namespace palpate::message {
namespace {

using testing::ElementsAre;

std::vector<std::uint8_t> bytes_of(const auto& message) {
  std::vector<std::uint8_t> bytes;
  encode(message, bytes);
  return bytes;
}

Joy joy() {
  Joy joy;
  joy.header = {{1, 2}, "abc"};
  joy.axes = {1};
  joy.buttons = {7};
  return joy;
}

TEST(Cdr, AlignsValuesToTheirSizeBehindTheHead) {
  EXPECT_THAT(bytes_of(joy()), ElementsAre(0, 1, 0, 0,                    // little endian, plain
                                           1, 0, 0, 0, 2, 0, 0, 0,        // the stamp
                                           4, 0, 0, 0, 'a', 'b', 'c', 0,  // with its end
                                           1, 0, 0, 0, 0, 0, 0x80, 0x3f,  // one axis
                                           1, 0, 0, 0, 7, 0, 0, 0));      // one button
}

TEST(Cdr, PutsDoublesAtMultiplesOfEightCountedFromBehindTheHead) {
  PoseStamped pose;
  pose.header.frame_id = "w";
  pose.pose.position.x = 1;
  const std::vector<std::uint8_t> bytes = bytes_of(pose);
  EXPECT_EQ(bytes.size(), 4U + 16U + 56U);
  EXPECT_EQ(bytes[4 + 16 + 7], 0x3f);
}

TEST(Cdr, ReadsWhatABigEndianMachineWrote) {
  const std::vector<std::uint8_t> bytes{0, 0, 0, 0, 0x3f, 0xf8, 0, 0, 0, 0, 0, 0};
  Float64 number;
  decode(std::span<const std::uint8_t>(bytes), number);
  EXPECT_EQ(number.data, 1.5);
}

TEST(Cdr, GivesBackWhatWasPutIn) {
  Marker marker;
  marker.header.frame_id = "world";
  marker.points = {{1, 2, 3}, {4, 5, 6}};
  marker.text = "text";
  marker.mesh_file.data = {1, 2, 3};
  marker.mesh_use_embedded_materials = true;
  const MarkerArray array{{marker, marker}};
  MarkerArray read;
  decode(std::span<const std::uint8_t>(bytes_of(array)), read);
  EXPECT_EQ(bytes_of(read), bytes_of(array));
  EXPECT_TRUE(read.markers[1].mesh_use_embedded_materials);
}

TEST(Cdr, RefusesAMessageThatIsCutAtAnyByte) {
  const std::vector<std::uint8_t> whole = bytes_of(joy());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    Joy read;
    EXPECT_THROW(decode(std::span(whole.data(), size), read), Error) << size;
  }
}

TEST(Cdr, TakesNoMemoryForElementsThatAreOnlyAnnounced) {
  std::vector<std::uint8_t> bytes{0, 1, 0, 0, 0xff, 0xff, 0xff, 0x7f};
  TFMessage frames;
  EXPECT_THROW(decode(std::span<const std::uint8_t>(bytes), frames), Error);
  Float64MultiArray numbers;
  bytes.insert(bytes.end(), {0, 0, 0, 0, 0xff, 0xff, 0xff, 0x1f});
  bytes[4] = bytes[5] = bytes[6] = bytes[7] = 0;
  EXPECT_THROW(decode(std::span<const std::uint8_t>(bytes), numbers), Error);
}

TEST(Cdr, RefusesOtherEncodingsInWords) {
  const std::vector<std::uint8_t> bytes{0, 7, 0, 0, 1};
  Bool flag;
  EXPECT_THAT([&] { decode(std::span<const std::uint8_t>(bytes), flag); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("XCDR version 1")));
}

TEST(Schema, IsWrittenAsRosbagsHoldIt) {
  EXPECT_EQ(
      schema_of<TwistStamped>(),
      "std_msgs/Header header\ngeometry_msgs/Twist twist\n" + std::string(80, '=') +
          "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
          std::string(80, '=') + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" +
          std::string(80, '=') +
          "\nMSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 "
          "angular\n" +
          std::string(80, '=') + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n");
  EXPECT_THAT(schema_of<CameraInfo>(), testing::HasSubstr("float64[] d\nfloat64[9] k\n"));
}

TEST(Schema, NamesTypesAsRosAndDdsDo) {
  EXPECT_EQ(ros_name("sensor_msgs/Image"), "sensor_msgs/msg/Image");
  EXPECT_EQ(dds_name("sensor_msgs/Image"), "sensor_msgs::msg::dds_::Image_");
}

}  // namespace
}  // namespace palpate::message
