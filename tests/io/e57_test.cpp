// E57 files: columns of every kind, poses, several scans, and what a cloud keeps of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "io/e57/contents.hpp"
#include "io/e57/packets.hpp"
#include "io/e57_bytes.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Numbers = std::vector<std::int64_t>;

// Points on the x axis at 1, 2, 3 ... m.
std::vector<E57TestField> line(std::size_t count) {
  std::vector<double> x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = static_cast<double>(i + 1);
  const std::vector<double> zero(count, 0);
  return {e57_doubles("cartesianX", x), e57_singles("cartesianY", zero),
          e57_doubles("cartesianZ", zero)};
}

std::vector<E57TestField> line_with(std::size_t count, const std::vector<E57TestField>& more) {
  std::vector<E57TestField> fields = line(count);
  fields.insert(fields.end(), more.begin(), more.end());
  return fields;
}

CloudFile read_scans(const std::vector<E57TestScan>& scans, const std::string& name = "a.e57",
                     const ReadOptions& options = {}) {
  return read_text(E57TestFile(scans).bytes(), name, options);
}

std::string refused_scans(const std::vector<E57TestScan>& scans,
                          const std::string& name = "a.e57") {
  return refusal(E57TestFile(scans).bytes(), name);
}

// All numbers of a column, as the packets of the only scan give them.
std::vector<double> column_of(const E57TestField& field, std::size_t packet) {
  const std::string bytes = E57TestFile({{.fields = {field}, .packet = packet}}).bytes();
  const ReadOptions options;
  const io::Input input{std::as_bytes(std::span(bytes)), "a.e57", options};
  io::E57Pages pages(input);
  const io::E57Contents contents = io::read_e57_contents(input, pages);
  io::E57Packets packets(input, pages, contents.scans.at(0), {0});
  std::vector<double> all;
  while (const std::size_t count = packets.next()) {
    EXPECT_EQ(packets.values(0).size(), count);
    all.insert(all.end(), packets.values(0).begin(), packets.values(0).end());
  }
  return all;
}

TEST(E57, ReadsIntegersOfEveryWidth) {
  std::mt19937_64 random(1);
  for (unsigned bits = 0; bits <= 64; ++bits) {
    const std::uint64_t range =
        bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;  // of what is stored
    const std::int64_t least = bits == 64 ? std::numeric_limits<std::int64_t>::min() : -5;
    const auto most = static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + range);
    if (most < least) continue;  // 63 bits from -5 on end within int64, 64 do so from its least
    Numbers values;
    std::vector<double> expected;
    for (int i = 0; i < 301; ++i) {
      const auto value = static_cast<std::int64_t>(static_cast<std::uint64_t>(least) +
                                                   (i == 0 ? range : random() & range));
      values.push_back(value);
      expected.push_back(static_cast<double>(value));
    }
    for (const std::size_t packet : {7, 300}) {
      EXPECT_EQ(column_of(e57_integers("n", least, most, values), packet), expected) << bits;
    }
  }
}

// A column of 0 bits has all its numbers at once; they are still given in small pieces.
TEST(E57, GivesTheNumbersOfAConstantColumnInPieces) {
  constexpr std::size_t kCount = 50'000;
  const E57TestField filler{"words", R"(type="String")", 8, std::vector<std::uint64_t>(kCount)};
  const std::string bytes =
      E57TestFile({{{e57_integers("n", 3, 3, Numbers(kCount, 3)), filler}}}).bytes();
  const ReadOptions options;
  const io::Input input{std::as_bytes(std::span(bytes)), "a.e57", options};
  io::E57Pages pages(input);
  const io::E57Contents contents = io::read_e57_contents(input, pages);
  io::E57Packets packets(input, pages, contents.scans.at(0), {0});
  std::size_t all = 0;
  while (const std::size_t count = packets.next()) {
    ASSERT_LE(count, 10'000u);
    EXPECT_EQ(packets.values(0), std::vector<double>(count, 3));
    all += count;
  }
  EXPECT_EQ(all, kCount);
}

TEST(E57, ReadsScaledIntegersAndFloatsToTheLastBit) {
  EXPECT_THAT(column_of(e57_scaled("n", -100, 900, 0.001, 7.5, {-100, 0, 900}), 9),
              ElementsAre(-100 * 0.001 + 7.5, 7.5, 900 * 0.001 + 7.5));
  const std::vector<double> values{0.1, -1e300, 5e-324, 1.0 / 3};
  EXPECT_EQ(column_of(e57_doubles("n", values), 11), values);
  EXPECT_THAT(column_of(e57_singles("n", {0.1, -2e30}), 5),
              ElementsAre(static_cast<double>(0.1F), static_cast<double>(-2e30F)));
}

TEST(E57, ReadsColumnsThatComeUnevenly) {
  constexpr std::size_t kCount = 5000;
  Numbers shades;
  for (std::size_t i = 0; i < kCount; ++i) shades.push_back(static_cast<std::int64_t>(i % 100));
  for (const std::size_t packet : {13, 500, 20000}) {
    const E57TestScan scan{.fields = line_with(kCount, {e57_integers("intensity", 0, 99, shades)}),
                           .packet = packet};
    const CloudFile file = read_scans({scan});
    ASSERT_EQ(file.cloud.size(), kCount) << packet;
    EXPECT_EQ(file.format, "E57");
    for (std::size_t i = 0; i < kCount; ++i) {
      ASSERT_EQ(file.cloud.point(i), Eigen::Vector3d(static_cast<double>(i + 1), 0, 0)) << i;
      ASSERT_EQ(file.cloud.intensities[i], static_cast<float>(i % 100)) << i;
    }
  }
}

TEST(E57, SkipsColumnsThatItDoesNotKnow) {
  const E57TestField words{"riegl:words", R"(type="String")", 8, {'a', 'b', 'c', 'd', 'e'}};
  const CloudFile file =
      read_scans({{.fields = line_with(2, {words, e57_integers("timeStamp", 0, 9, {7, 8})})}});
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_TRUE(file.cloud.intensities.empty() && file.cloud.colors.empty());
}

TEST(E57, MakesPointsOfRangeAzimuthAndElevation) {
  constexpr double kRight = std::numbers::pi / 2;
  const E57TestScan scan{{e57_doubles("sphericalRange", {2, 3, 4}),
                          e57_doubles("sphericalAzimuth", {0, kRight, 1}),
                          e57_doubles("sphericalElevation", {0, 0, -kRight})}};
  const CloudFile file = read_scans({scan});
  EXPECT_TRUE(file.cloud.point(0).isApprox(Eigen::Vector3d(2, 0, 0), 1e-6));
  EXPECT_TRUE(file.cloud.point(1).isApprox(Eigen::Vector3d(0, 3, 0), 1e-6));
  EXPECT_TRUE(file.cloud.point(2).isApprox(Eigen::Vector3d(0, 0, -4), 1e-6));
}

TEST(E57, PutsAScanAndItsNormalsWhereItsPoseSays) {
  const double half = std::sqrt(0.5);  // a quarter turn about z
  const E57TestScan scan{
      line_with(1, {e57_singles("nor:normalX", {2}), e57_singles("nor:normalY", {0}),
                    e57_singles("nor:normalZ", {0})}),
      e57_pose({half, 0, 0, half}, {1e6, 20, 30})};
  const CloudFile file = read_scans({scan});
  EXPECT_LT((file.cloud.point(0) - Eigen::Vector3d(1e6, 21, 30)).norm(), 1e-9);
  EXPECT_TRUE(file.cloud.normals.at(0).isApprox(Eigen::Vector3f(0, 1, 0), 1e-6F));
  EXPECT_EQ(file.cloud.viewpoint, Eigen::Vector3d(1e6, 20, 30));
  const CloudFile feet = read_scans({scan}, "a.e57", {.scale = 0.5});
  EXPECT_LT((feet.cloud.point(0) - Eigen::Vector3d(5e5, 10.5, 15)).norm(), 1e-9);
  EXPECT_EQ(feet.cloud.viewpoint, Eigen::Vector3d(5e5, 10, 15));
}

TEST(E57, DropsAndCountsInvalidPoints) {
  const E57TestField state = e57_integers("cartesianInvalidState", 0, 2, {0, 1, 2, 0});
  const CloudFile file = read_scans({{.fields = line_with(4, {state})}});
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.declared, 4u);
  EXPECT_EQ(file.dropped, 2u);
  EXPECT_EQ(file.cloud.point(1).x(), 4);
}

TEST(E57, BringsColoursToBytesByTheirLimits) {
  const auto colors = [](const std::vector<double>& v) {
    return std::vector{e57_singles("colorRed", v), e57_singles("colorGreen", v),
                       e57_singles("colorBlue", v)};
  };
  const auto integers = [](std::int64_t most, const Numbers& v) {
    return std::vector{e57_integers("colorRed", 0, most, v), e57_integers("colorGreen", 0, most, v),
                       e57_integers("colorBlue", 0, most, v)};
  };
  const auto reds = [](const E57TestScan& scan) {
    const CloudFile file = read_scans({scan});
    return std::vector<int>{file.cloud.colors.at(0)[0], file.cloud.colors.at(1)[0]};
  };
  EXPECT_THAT(reds({line_with(2, integers(255, {17, 255}))}), ElementsAre(17, 255));
  EXPECT_THAT(reds({line_with(2, integers(65535, {257, 65535}))}), ElementsAre(1, 255));
  EXPECT_THAT(reds({line_with(2, colors({0.2, 1}))}), ElementsAre(51, 255));
  std::string limits;
  for (const char* name : {"Red", "Green", "Blue"}) {
    limits += fmt::format("<color{0}Minimum>100</color{0}Minimum>", name) +
              fmt::format("<color{0}Maximum>200</color{0}Maximum>", name);
  }
  limits = "<colorLimits>" + limits + "</colorLimits>";
  EXPECT_THAT(reds({line_with(2, integers(255, {100, 200})), limits}), ElementsAre(0, 255));
}

TEST(E57, JoinsItsScansInTheFilesFrame) {
  const E57TestField shades = e57_integers("intensity", 0, 9, {3, 4});
  const E57TestScan first{line_with(2, {shades}), e57_pose({1, 0, 0, 0}, {0, 10, 0}), "kitchen"};
  const E57TestScan second{line_with(2, {shades}), e57_pose({0, 0, 0, 1}, {0, 0, 5}), "hall"};
  const E57TestScan none{line(0)};
  const CloudFile all = read_scans({first, none, second});
  EXPECT_EQ(all.format, "E57, 2 scans joined");
  ASSERT_EQ(all.cloud.size(), 4u);
  EXPECT_EQ(all.cloud.point(1), Eigen::Vector3d(2, 10, 0));
  EXPECT_EQ(all.cloud.point(3), Eigen::Vector3d(-2, 0, 5));
  EXPECT_THAT(all.cloud.intensities, ElementsAre(3, 4, 3, 4));
  EXPECT_FALSE(all.cloud.viewpoint);

  const CloudFile one = read_scans({first, none, second}, "a.e57#3");
  EXPECT_EQ(one.format, "E57, scan 3 of 3 \"hall\"");
  ASSERT_EQ(one.cloud.size(), 2u);
  EXPECT_EQ(one.cloud.point(0), Eigen::Vector3d(-1, 0, 5));
  EXPECT_EQ(one.cloud.viewpoint, Eigen::Vector3d(0, 0, 5));

  const CloudFile mixed = read_scans({first, {line(2)}});
  EXPECT_EQ(mixed.cloud.size(), 4u);
  EXPECT_TRUE(mixed.cloud.intensities.empty()) << "only one scan has them";
}

TEST(E57, SaysWhichScansThereAre) {
  const E57TestScan scan{line(2)};
  EXPECT_THAT(refused_scans({scan, scan, scan}, "h.e57#5"),
              HasSubstr("h.e57#5: there are 3 scans"));
  EXPECT_THAT(refused_scans({scan}, "h.e57#0"), HasSubstr("there are 1 scans"));
  EXPECT_THAT(refused_scans({{line(0)}, scan}, "h.e57#1"), HasSubstr("no scan holds points"));
  EXPECT_THAT(refusal(E57TestFile({}, 2).bytes(), "h.e57"),
              HasSubstr("h.e57: no scan holds points (2 images)"));
}

// A cloud that a program exported has a scan, too, but no scanner was at its origin.
TEST(E57, KnowsAViewpointOnlyWhereAScannerStood) {
  const auto viewpoint = [](const E57TestScan& scan) { return read_scans({scan}).cloud.viewpoint; };
  EXPECT_FALSE(viewpoint({line(1)}));
  EXPECT_FALSE(viewpoint({line(1), e57_pose({1, 0, 0, 0}, {4e5, 5e6, 0})})) << "a shift";
  EXPECT_EQ(viewpoint({line(1), e57_pose({0, 0, 0, 1}, {1, 2, 3})}), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(viewpoint({line_with(
                1, {e57_integers("rowIndex", 0, 5, {1}), e57_integers("columnIndex", 0, 5, {2})})}),
            Eigen::Vector3d(0, 0, 0));
}

TEST(E57, ListsTheScansOfAFileAsPathsThatCanBeRead) {
  const test::Folder folder;
  const E57TestScan scan{line(2), "", "a"};
  folder.write("two.e57", E57TestFile({scan, {line(0)}, {line(3)}}).bytes());
  folder.write("one.E57", E57TestFile({scan}).bytes());
  folder.write("b.e57#1", "1 2 3\n");
  const auto scans = scans_of(folder / "two.e57");
  ASSERT_THAT(scans, ElementsAre(folder / "two.e57#1", folder / "two.e57#3"));
  EXPECT_EQ(read_cloud(scans[1]).size(), 3u);
  EXPECT_EQ(read_cloud(folder / "two.e57").size(), 5u);
  EXPECT_EQ(read_cloud(folder / "one.E57#1").size(), 2u);
  EXPECT_EQ(read_cloud(folder / "b.e57#1").size(), 1u) << "a file that has such a name";
  for (const char* other : {"one.E57", "absent.e57", "b.e57#1", "two.e57#1"}) {
    EXPECT_THAT(scans_of(folder / other), ElementsAre(folder / other));
  }
}

}  // namespace
}  // namespace palpate
