#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "io/formats.hpp"
#include "io/las_bytes.hpp"
#include "support/counts.hpp"

namespace palpate {
namespace {

using test::kLargestCount;
using testing::HasSubstr;

bool has_color(int format) {
  return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}

TEST(Las, ReadsEveryPointFormat) {
  for (int format = 0; format <= 10; ++format) {
    const int minor = format >= 6 ? 4 : format >= 4 ? 3 : 2;
    const CloudFile file = read_text(las_bytes(minor, format, las_points(), 7));
    ASSERT_EQ(file.cloud.size(), 2u) << format;
    EXPECT_EQ(file.declared, 3u);
    EXPECT_EQ(file.dropped, 1u);  // withheld
    EXPECT_NEAR(file.cloud.point(0).x(), 637291 - 208.87, 1e-4);
    EXPECT_NEAR(file.cloud.point(1).y(), 851210 - 2308.06, 1e-4);
    EXPECT_EQ(file.cloud.intensities, (std::vector<float>{17, 4000}));
    ASSERT_EQ(file.cloud.colors.size(), has_color(format) ? 2u : 0u) << format;
    if (has_color(format)) {
      EXPECT_EQ(file.cloud.colors[0], (std::array<std::uint8_t, 3>{0, 1, 255}));
    }
  }
}

TEST(Las, KeepsTheDigitsOfSurveyCoordinates) {
  const CloudFile file = read_text(las_bytes(2, 0, las_points()));
  EXPECT_GT(file.cloud.origin.norm(), 1e5);
  for (const auto& p : file.cloud.positions) EXPECT_LT(p.norm(), 1e4F);
  const CloudFile feet = read_text(las_bytes(2, 0, las_points()), "a.las", {.scale = 0.3048});
  EXPECT_NEAR(feet.cloud.point(0).x(), 0.3048 * (637291 - 208.87), 1e-4);
}

TEST(Las, LeavesOutColumnsThatAreZeroThroughout) {
  const CloudFile file = read_text(las_bytes(2, 2, {{.number = {1, 2, 3}}}));
  EXPECT_TRUE(file.cloud.intensities.empty());
  EXPECT_TRUE(file.cloud.colors.empty());
}

TEST(Las, TakesColoursOfEightBitsForWhatTheyAre) {
  const CloudFile file = read_text(las_bytes(2, 2, {{.number = {1, 2, 3}, .color = {1, 2, 255}}}));
  EXPECT_EQ(file.cloud.colors[0], (std::array<std::uint8_t, 3>{1, 2, 255}));
}

TEST(Las, VersionZeroHasNoWithheldPoints) {
  EXPECT_EQ(read_text(las_bytes(0, 0, las_points())).cloud.size(), 3u);
}

TEST(Las, ReadsThe64BitCountOfLas14) {
  std::string bytes = las_bytes(4, 1, las_points());
  overwrite<std::uint32_t>(bytes, 107, 0);
  EXPECT_EQ(read_text(bytes).declared, 3u);
  overwrite<std::uint64_t>(bytes, 247, 0);
  overwrite<std::uint32_t>(bytes, 107, 2);  // a writer that fills in the old field alone
  EXPECT_EQ(read_text(bytes).declared, 2u);
  overwrite(bytes, 247, std::numeric_limits<std::uint64_t>::max());
  EXPECT_THAT(refusal(bytes), HasSubstr("after 3 of " + kLargestCount + " points"));
}

TEST(Las, SaysHowManyPointsOfACutFileAreThere) {
  const std::string bytes = las_bytes(2, 3, las_points());
  EXPECT_THAT(refusal(bytes.substr(0, bytes.size() - 1)), HasSubstr("after 2 of 3 points"));
  EXPECT_THAT(refusal(bytes.substr(0, 200)), HasSubstr("inside its LAS header"));
  EXPECT_THAT(refusal(las_bytes(4, 6, {}).substr(0, 300)), HasSubstr("inside its LAS header"));
  std::string long_header = las_bytes(3, 3, {}).substr(0, 232);  // waveforms are at byte 227
  overwrite<std::uint16_t>(long_header, 94, 235);
  EXPECT_THAT(refusal(long_header), HasSubstr("inside its LAS header of 235 bytes"));
}

TEST(Las, NamesTheByteOfWhatIsWrong) {
  const auto broken = [](std::size_t offset, auto value) {
    std::string bytes = las_bytes(2, 3, las_points());
    overwrite(bytes, offset, value);
    return refusal(bytes, "a.las");
  };
  EXPECT_THAT(broken(24, std::uint8_t{2}), HasSubstr("a.las, byte 24: LAS version 2.2"));
  EXPECT_THAT(broken(104, std::uint8_t{11}), HasSubstr("byte 104: LAS point format 11"));
  EXPECT_THAT(broken(105, std::uint16_t{20}), HasSubstr("byte 105: point records of 20 bytes"));
  EXPECT_THAT(broken(96, std::uint32_t{3}), HasSubstr("byte 94"));
  EXPECT_THAT(broken(131, 0.0), HasSubstr("byte 131: invalid coordinate scale of 0"));
  EXPECT_THAT(broken(163, std::numeric_limits<double>::infinity()), HasSubstr("byte 163"));
  EXPECT_THAT(refusal(las_bytes(2, 0, {})), HasSubstr("holds no points"));
}

}  // namespace
}  // namespace palpate
