// LAZ files give the cloud that their LAS originals give; damaged ones give errors that help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "io/formats.hpp"
#include "io/laz_encoder.hpp"
#include "io/laz_survey.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

void expect_same(const CloudFile& a, const CloudFile& b) {
  EXPECT_EQ(a.declared, b.declared);
  EXPECT_EQ(a.dropped, b.dropped);
  EXPECT_EQ(a.cloud.origin, b.cloud.origin);
  EXPECT_EQ(a.cloud.positions, b.cloud.positions);
  EXPECT_EQ(a.cloud.intensities, b.cloud.intensities);
  EXPECT_EQ(a.cloud.colors, b.cloud.colors);
}

TEST(Laz, GivesTheCloudOfTheLasOriginal) {
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    SCOPED_TRACE(format);
    const std::string las = survey_of({.format = format, .points = 5000, .extra = 3});
    const CloudFile plain = read_text(las);
    EXPECT_GT(plain.dropped, 0u);
    EXPECT_FALSE(plain.cloud.intensities.empty());
    for (const LazWriting& writing : {LazWriting{}, LazWriting{.chunk = 300, .varying = true},
                                      LazWriting{.chunk = 1, .place_at_end = true}}) {
      const CloudFile packed = read_text(laz_of(las, writing));
      EXPECT_THAT(packed.format, HasSubstr("LAZ"));
      expect_same(packed, plain);
    }
  }
}

TEST(Laz, ReadsNothingFromChunksBehindTheLastPoint) {
  std::string laz = laz_of(survey_of({.points = 3000}), {.chunk = 100});
  overwrite<std::uint32_t>(laz, 107, 2900);
  EXPECT_EQ(read_text(laz).declared, 2900u);
}

TEST(Laz, GivesTheSameOnOneThread) {
  const std::string laz = laz_of(survey_of({.format = 7, .points = 5000}), {.chunk = 100});
  const CloudFile many = read_text(laz);
  const ThreadLimit one(1);
  expect_same(read_text(laz), many);
}

TEST(Laz, TellsItsProgressOnTheCallersThreadAndCanBeStopped) {
  const std::string laz = laz_of(survey_of({.points = 20000}), {.chunk = 50});
  const auto caller = std::this_thread::get_id();
  double last = 0;
  std::size_t calls = 0;
  ReadOptions options;
  options.progress = [&](double done) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_GE(done, last);
    last = done;
    ++calls;
  };
  (void)read_text(laz, "a.laz", options);
  EXPECT_EQ(last, 1);
  EXPECT_GT(calls, 10u);
  struct Stop {};
  options.progress = [](double) { throw Stop(); };
  EXPECT_THROW((void)read_text(laz, "a.laz", options), Stop);
}

constexpr std::size_t kDescription = 227 + 54;          // "laszip encoded" in a file of version 1.2
constexpr std::size_t kPoints = kDescription + 34 + 6;  // of format 0

std::string one_chunk(std::size_t points = 3000) {
  return laz_of(survey_of({.points = points}));
}

TEST(Laz, NamesWhatItDoesNotRead) {
  const auto broken = [](std::size_t offset, auto value) {
    std::string bytes = one_chunk();
    overwrite(bytes, offset, value);
    return refusal(bytes, "a.laz");
  };
  using Number = std::uint16_t;
  EXPECT_THAT(broken(kDescription, Number{1}), HasSubstr("byte 281: point format 0 compressed by "
                                                         "compressor 1 of LASzip"));
  EXPECT_THAT(broken(kDescription, Number{3}), HasSubstr("compressor 3"));
  EXPECT_THAT(broken(kDescription + 34 + 4, Number{1}), HasSubstr("version 1, which is not read"));
  EXPECT_THAT(broken(kDescription + 32, Number{2}), HasSubstr("2 compressed parts"));
  EXPECT_THAT(broken(kDescription + 12, std::uint32_t{0}), HasSubstr("chunks of 0 points"));
  EXPECT_THAT(broken(kDescription - 54 + 18, Number{1}), HasSubstr("how it is compressed"));
  std::string waves = laz_of(survey_of({.format = 3}));
  overwrite(waves, 105, std::uint16_t{63});
  for (const int format : {4, 5}) {
    overwrite(waves, 104, static_cast<std::uint8_t>(format | 128));
    EXPECT_THAT(refusal(waves), HasSubstr("holds waveforms"));
  }
}

TEST(Laz, NamesTheChunkAndTheByteWhereAFileEnds) {
  std::string bytes = laz_of(survey_of({.points = 3000}), {.chunk = 1000});
  const auto table = static_cast<std::size_t>(load<std::int64_t>(bytes, kPoints));
  EXPECT_THAT(refusal(bytes.substr(0, table), "a.laz"),
              HasSubstr("the chunk table at byte " + std::to_string(table) + " is outside"));
  EXPECT_THAT(refusal(bytes.substr(0, table + 10)), HasSubstr("ends inside the sizes of chunk"));
  overwrite(bytes, kPoints, std::numeric_limits<std::int64_t>::max());
  EXPECT_THAT(refusal(bytes), HasSubstr("byte 321: the chunk table at byte 9223372036854775807"));
}

TEST(Laz, NoticesAChunkThatEndsBeforeItsLastPoint) {
  std::string bytes = one_chunk(3000);
  overwrite<std::uint32_t>(bytes, 107, 40000);
  EXPECT_THAT(refusal(bytes), HasSubstr("byte 329: chunk 1 of 1 ends inside its point 30"));
}

// A layer that ends too early, in a chunk which tells of it.
TEST(Laz, NoticesLayersThatEndTooEarly) {
  std::string bytes = laz_of(survey_of({.format = 6}));
  const std::size_t sizes = 375 + 54 + 34 + 6 + 8 + 30 + 4;
  ASSERT_GT(load<std::uint32_t>(bytes, sizes), 1000u);  // x and y
  std::string shorter = bytes;
  overwrite<std::uint32_t>(shorter, sizes, 500);
  EXPECT_THAT(refusal(shorter), HasSubstr("chunk 1 of 1 ends inside its point"));
  overwrite(shorter, sizes, std::numeric_limits<std::uint32_t>::max());
  EXPECT_THAT(refusal(shorter), HasSubstr("ends inside its point 2 of 3000"));
  overwrite<std::uint32_t>(bytes, sizes - 4, 2999);  // points
  EXPECT_THAT(refusal(bytes), HasSubstr("ends inside its point 2 of 3000"));
}

TEST(Laz, HoldsNoMorePointsThanItsBytesCan) {
  std::string bytes = one_chunk();
  overwrite(bytes, 107, std::numeric_limits<std::uint32_t>::max());
  EXPECT_THAT(refusal(bytes), HasSubstr("50000 points in 1 chunks, but the header announces"));
  overwrite(bytes, kDescription + 12, std::numeric_limits<std::uint32_t>::max() - 1);
  overwrite(bytes, 107, std::numeric_limits<std::uint32_t>::max() - 1);
  EXPECT_THAT(refusal(bytes), HasSubstr("chunk 1 of 4294967294 points"));
  const std::size_t table = static_cast<std::size_t>(load<std::int64_t>(bytes, kPoints));
  overwrite(bytes, table + 4, std::numeric_limits<std::uint32_t>::max());
  EXPECT_THAT(refusal(bytes), HasSubstr("a table of 4294967295 chunks"));
}

// Each chunk may be as large as it says, but not all of them together.
TEST(Laz, HoldsNoMorePointsInAllThanItsBytesCan) {
  std::string bytes = laz_of(survey_of({.points = 3000}), {.chunk = 100});
  overwrite<std::uint32_t>(bytes, kDescription + 12, 300'000);
  overwrite<std::uint32_t>(bytes, 107, 9'000'000);
  EXPECT_THAT(refusal(bytes), HasSubstr("announces 9000000 points in"));
}

TEST(Laz, AFileCutAnywhereIsRefused) {
  for (const int format : {3, 8}) {
    const std::string bytes = laz_of(survey_of({.format = format}), {.chunk = 500});
    for (std::size_t size = 0; size + 16 < bytes.size(); size += 97) {
      EXPECT_NE(refusal(bytes.substr(0, size)), "no error") << size;
    }
  }
}

TEST(Laz, DamagedBytesGiveAnErrorOrPoints) {
  std::mt19937 random(7);
  for (const int format : {1, 3, 7}) {
    const std::string whole = laz_of(survey_of({.format = format, .points = 600, .extra = 2}),
                                     {.chunk = 200, .varying = true});
    std::size_t refused = 0;
    for (int i = 0; i < 400; ++i) {
      std::string bytes = whole;
      for (int k = 0; k <= i % 4; ++k) {
        bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      }
      if (refusal(bytes) != "no error") ++refused;
    }
    EXPECT_GT(refused, 10u) << format;
    EXPECT_LT(refused, 400u) << format;
  }
}

}  // namespace
}  // namespace palpate
