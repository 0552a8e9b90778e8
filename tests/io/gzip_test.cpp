#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "io/file_bytes.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

std::string gzip(const std::string& text) {
  std::string packed(compressBound(static_cast<uLong>(text.size())) + 64, '\0');
  z_stream z{};
  deflateInit2(&z, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  z.avail_in = static_cast<uInt>(text.size());
  z.next_out = reinterpret_cast<Bytef*>(packed.data());
  z.avail_out = static_cast<uInt>(packed.size());
  deflate(&z, Z_FINISH);
  packed.resize(z.total_out);
  deflateEnd(&z);
  return packed;
}

std::string many_points(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::to_string(i % 97) + " 2 3\n";
  return text;
}

TEST(Gzip, UnpacksWhateverIsInside) {
  const CloudFile file = read_text(gzip(many_points(100000)), "a.xyz.gz");
  EXPECT_EQ(file.cloud.size(), 100000u);
  EXPECT_EQ(file.format, "text, gzip");
  EXPECT_EQ(read_text(gzip("v 1 2 3\n"), "a").format, "OBJ, gzip");
}

TEST(Gzip, UnpacksSeveralMembersAndIgnoresPadding) {
  const std::string two = gzip(many_points(3)) + gzip(many_points(4)) + std::string(100, '\0');
  EXPECT_EQ(read_text(two).cloud.size(), 7u);
}

TEST(Gzip, SaysWhenDataIsCutOrDamaged) {
  std::string packed = gzip(many_points(1000));
  for (const std::size_t cut : {std::size_t{1}, std::size_t{9}, packed.size() / 2}) {
    EXPECT_THAT(refusal(packed.substr(0, packed.size() - cut), "a.gz"),
                HasSubstr("a.gz: the gzip data ends early"));
  }
  packed[packed.size() / 2] = static_cast<char>(~packed[packed.size() / 2]);
  EXPECT_THAT(refusal(packed), HasSubstr("damaged"));
}

TEST(Gzip, NamesLinesOfTheTextInside) {
  EXPECT_THAT(refusal(gzip("1 2 3\n4 5 six\n"), "a.xyz.gz"), HasSubstr("a.xyz, line 2"));
}

TEST(Gzip, StopsABombEarly) {
  const std::string bomb = gzip(std::string(std::size_t{80} << 20U, ' '));
  EXPECT_THAT(refusal(bomb), HasSubstr("unpacks to more than 64 MiB"));
  EXPECT_THAT(refusal(gzip(std::string(std::size_t{80} << 20U, '\0')), "a.xyz.gz"),
              HasSubstr("a.xyz: unknown file type"))
      << "its first bytes are enough";
}

TEST(Gzip, IsNotUnpackedTwice) {
  EXPECT_THAT(refusal(gzip(gzip(many_points(3)))), HasSubstr("compressed with gzip twice"));
}

}  // namespace
}  // namespace palpate
