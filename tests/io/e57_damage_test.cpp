// Damaged and hostile E57 files: each is refused with words, or read, and none takes long.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "io/e57_bytes.hpp"
#include "support/counts.hpp"

namespace palpate {
namespace {

using test::count_short_of_bits;
using testing::HasSubstr;
using testing::StartsWith;

E57TestScan scan_of(std::size_t count) {
  const std::vector<double> zeros(count, 0);
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<std::int64_t>(i % 500));
  return {{e57_doubles("cartesianX", zeros), e57_singles("cartesianY", zeros),
           e57_scaled("cartesianZ", 0, 499, 0.01, 0, numbers),
           e57_integers("intensity", 0, 499, numbers)}};
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("not there: " + std::string(what));
  return text.replace(at, what.size(), by);
}

// The reader's refusal of a file whose XML says `by` in the place of `what`.
std::string refused_with(std::string_view what, std::string_view by) {
  const E57TestFile file({scan_of(5)});
  return refusal(file.with_xml(replaced(file.xml(), what, by)), "a.e57");
}

// Its refusal of a file whose data bytes differ from `place` on.
template <class T>
std::string refused_at(std::size_t place, T value) {
  std::string data = E57TestFile({scan_of(100)}).data();
  overwrite(data, place, value);
  return refusal(E57TestFile::paged(data), "a.e57");
}

TEST(E57Damage, NamesThePageThatIsDamaged) {
  std::string bytes = E57TestFile({scan_of(2000)}).bytes();
  EXPECT_EQ(refusal(bytes), "no error");
  bytes[3 * io::kE57Page + 500] ^= 4;
  EXPECT_THAT(refusal(bytes, "h.e57"),
              StartsWith("h.e57, byte 3072: page 3 is damaged (CRC). Download"));
}

TEST(E57Damage, RefusesAFileThatIsCutAnywhere) {
  const std::string bytes = E57TestFile({scan_of(300)}).bytes();
  for (std::size_t size = 8; size < bytes.size(); size += 97) {
    EXPECT_THAT(refusal(bytes.substr(0, size)), HasSubstr("the file ends")) << size;
  }
  const std::string data = E57TestFile({scan_of(300)}).data();
  for (std::size_t size = 8; size < data.size(); size += 97) {  // with pages that are whole
    EXPECT_NE(refusal(E57TestFile::paged(data.substr(0, size))), "no error") << size;
  }
}

TEST(E57Damage, SurvivesBytesThatChanged) {
  const std::string data = E57TestFile({scan_of(60), scan_of(10)}).data();
  std::mt19937 random(7);
  std::size_t refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string changed = data;
    for (unsigned k = random() % 4 + 1; k > 0; --k) {
      changed[8 + random() % (data.size() - 8)] = static_cast<char>(random());
    }
    refused += refusal(E57TestFile::paged(changed)) == "no error" ? 0 : 1;
  }
  EXPECT_GT(refused, 300u);
  EXPECT_LT(refused, 2999u);
}

TEST(E57Damage, AllocatesNothingByACountAlone) {
  const std::string most = count_short_of_bits(1);
  EXPECT_THAT(refused_with(R"(recordCount="5")", "recordCount=\"" + most + "\""),
              HasSubstr(most + " points of 114 bits announced in"));
  EXPECT_THAT(refused_with(R"(recordCount="5")", R"(recordCount="6")"),
              HasSubstr("a scan ends after 5 of 6 points"));
  E57TestScan constant = scan_of(1);
  for (E57TestField& field : constant.fields) {
    field = e57_integers(field.name, 3, 3, {3});
  }
  const E57TestFile file({constant});
  EXPECT_THAT(refusal(file.with_xml(
                  replaced(file.xml(), R"(recordCount="1")", R"(recordCount="4000000000")"))),
              HasSubstr("4000000000 points of 0 bits announced"));
  EXPECT_THAT(refused_at(48 + 8, std::uint64_t{1} << 62), HasSubstr("or one that leaves the file"));
  EXPECT_THAT(refused_at(32, std::uint64_t{1} << 62), HasSubstr("more than 64 MiB"));
}

TEST(E57Damage, RefusesScansWhosePointsLieAtOnePlace) {
  const E57TestFile file({scan_of(400)});
  const std::string& xml = file.xml();
  const std::size_t begin = xml.find("<vectorChild");
  const std::size_t end = xml.find("</data3D>");
  std::string copies;
  for (int i = 0; i < 5000; ++i) copies += xml.substr(begin, end - begin);
  // A large XML is a large file: the scans' sections together still have to fit.
  EXPECT_THAT(refusal(file.with_xml(replaced(xml, "</data3D>", copies + "</data3D>"))),
              HasSubstr("two scans lie at the same place"));
}

TEST(E57Damage, RefusesPacketsThatDoNotHoldWhatTheyAnnounce) {
  constexpr std::size_t kIndex = 48 + 32;       // place of the first packet, an index
  constexpr std::size_t kPacket = kIndex + 24;  // place of the first data packet
  EXPECT_THAT(refused_at(48, std::uint8_t{3}), HasSubstr("a.e57, byte 48: no section of points"));
  EXPECT_THAT(refused_at(48 + 16, std::uint64_t{1}), HasSubstr("points outside their section"));
  EXPECT_THAT(refused_at(kPacket, std::uint8_t{7}), HasSubstr("byte 104: a packet of type 7"));
  EXPECT_THAT(refused_at(kIndex + 2, std::uint16_t{1}),
              HasSubstr("a packet of type 0 and 2 bytes"));
  EXPECT_THAT(refused_at(kIndex + 2, std::uint16_t{65535}),
              HasSubstr("65536 bytes cannot be here"));
  EXPECT_THAT(refused_at(kPacket + 4, std::uint16_t{3}), HasSubstr("does not hold what"));
  EXPECT_THAT(refused_at(kPacket + 8, std::uint16_t{60000}), HasSubstr("does not hold what"));
}

TEST(E57Damage, SaysWhatIsWrongInTheHeader) {
  EXPECT_THAT(refused_at(8, std::uint32_t{2}), HasSubstr("byte 8: E57 version 2"));
  EXPECT_THAT(refused_at(40, std::uint64_t{4096}), HasSubstr("byte 40: pages of 4096 bytes"));
  EXPECT_THAT(refused_at(24, std::uint64_t{48}), HasSubstr("its XML is damaged at byte"));
}

TEST(E57Damage, SaysWhatIsWrongInTheXml) {
  EXPECT_THAT(refused_with("</e57Root>", ""), HasSubstr("its XML is damaged at byte"));
  EXPECT_THAT(refused_with("cartesianY ", "cartesianQ "),
              HasSubstr("\"a scan\" has no coordinates"));
  EXPECT_THAT(refused_with(R"(fileOffset="48")", ""), HasSubstr("gives '' for fileOffset"));
  EXPECT_THAT(refused_with(R"(maximum="499")", R"(maximum="-1")"), HasSubstr("'-1' for maximum"));
  EXPECT_THAT(refused_with(R"(scale="0.01")", R"(scale="inf")"), HasSubstr("'inf' for scale"));
  EXPECT_THAT(refused_with("<points ", e57_pose({0, 0, 0, 0}, {0, 0, 0}) + "<points "),
              HasSubstr("'0' for the length of a quaternion"));
  const E57TestFile file({scan_of(5)});
  EXPECT_THAT(refusal(file.with_xml("<other/>")), HasSubstr("its XML has no e57Root"));
  EXPECT_THAT(refusal(file.with_xml("")), HasSubstr("its XML is damaged at byte 0"));
}

TEST(E57Damage, TakesAMillionNestedElements) {
  constexpr std::size_t kDepth = 1'000'000;
  std::string nested;
  for (std::size_t i = 0; i < kDepth; ++i) nested += "<a>";
  for (std::size_t i = 0; i < kDepth; ++i) nested += "</a>";
  const E57TestFile file({scan_of(5)});
  EXPECT_EQ(refusal(file.with_xml(replaced(file.xml(), "<data3D", nested + "<data3D"))),
            "no error");
  EXPECT_THAT(refusal(file.with_xml(nested)), HasSubstr("no e57Root"));
}

// Columns of 0 bits need no packets, so the points are read whatever else the XML lists.
TEST(E57Damage, TakesAMillionColumnsAndElementsBesideThePoints) {
  constexpr std::size_t kCount = 100'000;
  const std::vector<std::int64_t> threes(kCount, 3);
  const E57TestField filler{"words", R"(type="String")", 8, std::vector<std::uint64_t>(kCount)};
  const E57TestFile file(
      {{{e57_integers("cartesianX", 3, 3, threes), e57_integers("cartesianY", 3, 3, threes),
         e57_integers("cartesianZ", 3, 3, threes), filler}}});
  std::string columns;
  std::string elements;
  for (std::size_t i = 0; i < 1'000'000; ++i) {
    columns += "<a/>";
    elements += "<b/>";
  }
  const std::string xml = replaced(replaced(file.xml(), "</prototype>", columns + "</prototype>"),
                                   "<points ", elements + "<points ");
  EXPECT_EQ(read_text(file.with_xml(xml), "a.e57").cloud.size(), kCount);
}

}  // namespace
}  // namespace palpate
