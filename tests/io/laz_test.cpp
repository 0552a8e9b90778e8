#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats.hpp"
#include "io/las_bytes.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

// Where CMake put the library of laszip_double.cpp.
const std::array<std::string, 2> kDouble{"libno-such-library.so", LASZIP_DOUBLE};

std::string compressed(int minor, int format) {
  std::string bytes = las_bytes(minor, format, las_points());
  bytes[104] = static_cast<char>(format | 128);
  return bytes;
}

CloudFile read_with(const std::string& bytes, std::span<const std::string> libraries) {
  const ReadOptions options;
  const io::Input input{std::as_bytes(std::span(bytes)), "a.laz", options};
  return io::read_laz(input, io::read_las_header(input), libraries);
}

std::string refusal_with(const std::string& bytes, std::span<const std::string> libraries) {
  try {
    (void)read_with(bytes, libraries);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Laz, ReadsThroughTheUsersLibraryWhatLasHolds) {
  for (const auto& [minor, format] : {std::pair{2, 3}, {2, 2}, {4, 6}, {4, 7}}) {
    const CloudFile plain = read_text(las_bytes(minor, format, las_points()));
    const CloudFile packed = read_with(compressed(minor, format), kDouble);
    EXPECT_THAT(packed.format, HasSubstr("LAZ"));
    EXPECT_EQ(packed.declared, plain.declared);
    EXPECT_EQ(packed.dropped, plain.dropped) << format;
    ASSERT_EQ(packed.cloud.size(), plain.cloud.size());
    for (std::size_t i = 0; i < plain.cloud.size(); ++i) {
      EXPECT_LT((packed.cloud.point(i) - plain.cloud.point(i)).norm(), 1e-3);
    }
    EXPECT_EQ(packed.cloud.intensities, plain.cloud.intensities);
    EXPECT_EQ(packed.cloud.colors, plain.cloud.colors);
  }
}

TEST(Laz, SaysHowToConvertWithoutTheLibrary) {
  const std::string absent[] = {"libno-such-library.so"};
  const std::string message = refusal_with(compressed(2, 3), absent);
  EXPECT_THAT(message, HasSubstr("3 points compressed as LAZ"));
  EXPECT_THAT(message, HasSubstr("pdal translate"));
  EXPECT_THAT(message, HasSubstr("LD_LIBRARY_PATH"));
}

TEST(Laz, ALibraryWithoutTheFunctionsIsNoLibrary) {
  const std::string other[] = {"libc.so.6"};
  EXPECT_THAT(refusal_with(compressed(2, 3), other), HasSubstr("not installed"));
}

TEST(Laz, PassesOnWhatTheLibrarySaysOfACutFile) {
  const std::string bytes = compressed(2, 3);
  const std::string message = refusal_with(bytes.substr(0, bytes.size() - 1), kDouble);
  EXPECT_THAT(message, HasSubstr("stopped after 2 of 3 points: the double's own words"));
}

}  // namespace
}  // namespace palpate
