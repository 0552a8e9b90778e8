// Damaged Potree stores are refused with words, and never crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "io/potree_writer.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

constexpr std::size_t kRecord = 22;  // bytes of a node of hierarchy.bin

class PotreeDamage : public testing::Test {
 protected:
  // What reading all of the store in the folder says.
  [[nodiscard]] std::string refusal() const {
    try {
      (void)read_cloud_file(folder_.path());
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  std::string refusal_of(const PotreeFiles& files) const {
    files.write(folder_);
    return refusal();
  }

  std::string refusal_of(const std::function<void(PotreeFiles&)>& change) const {
    PotreeFiles files = files_;
    change(files);
    return refusal_of(files);
  }

  // The same for one text of metadata.json in place of another.
  std::string with(const std::string& text, const std::string& other) const {
    PotreeFiles files = files_;
    const std::size_t at = files.metadata.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    files.metadata.replace(at, text.size(), other);
    return refusal_of(files);
  }

  // The same for another number in the record of a node.
  template <class T>
  std::string with_number(std::size_t record, std::size_t offset, T number) const {
    return refusal_of(
        [&](PotreeFiles& files) { overwrite(files.hierarchy, record * kRecord + offset, number); });
  }

  // The first record of that type.
  [[nodiscard]] std::size_t first_of(char type) const {
    std::size_t record = 0;
    while (files_.hierarchy.at(record * kRecord) != type) ++record;
    return record;
  }

  test::Folder folder_;
  PotreeFiles files_ = potree_of(potree_hill(5000), {.levels = 1, .in_node = 100});
};

TEST_F(PotreeDamage, OfTheMetadataIsNamed) {
  EXPECT_EQ(refusal_of(files_), "no error");
  EXPECT_THAT(with("\"2.0\"", "\"1.8\""), HasSubstr("metadata.json: version \"1.8\" of Potree"));
  EXPECT_THAT(with("\"2.0\"", "2"), HasSubstr("no text at version"));
  EXPECT_THAT(with("{\"version\"", "{{"), HasSubstr("its JSON is broken"));
  EXPECT_THAT(with("DEFAULT", "ZSTD"), HasSubstr("\"ZSTD\" is not known (DEFAULT, BROTLI)"));
  EXPECT_THAT(with("\"points\": 5000", "\"points\": -1"), HasSubstr("-1 at points is no count"));
  EXPECT_THAT(with("\"points\": 5000", "\"points\": 4999"), HasSubstr("json announces 4999"));
  EXPECT_THAT(with("\"points\": 5000", "\"points\": 1e400"), HasSubstr("its JSON is broken"));
  EXPECT_THAT(with("[0.001,", "[0,"), HasSubstr("must be above zero"));
  EXPECT_THAT(with("[0.001,", "[\"x\","), HasSubstr("no number at scale/0"));
  EXPECT_THAT(with("\"spacing\": ", "\"spacing\": -"), HasSubstr("a spacing of -8.192 in a cube"));
  EXPECT_THAT(with("\"spacing\": ", "\"spacing\": 9999"), HasSubstr("a spacing of 9999"));
  EXPECT_THAT(with("\"max\": [4", "\"max\": [8"), HasSubstr("the boundingBox is no cube"));
  EXPECT_THAT(with("\"offset\"", "\"offsets\""), HasSubstr("no number at offset/0"));
  EXPECT_THAT(with("\"offset\": [400000", "\"offset\": [1e308"), HasSubstr("none of the 5000"));
}

TEST_F(PotreeDamage, OfTheAttributesIsNamed) {
  EXPECT_THAT(with("\"position\"", "\"place\""), HasSubstr("no attribute \"position\""));
  EXPECT_THAT(with("\"int32\"", "\"float\""),
              HasSubstr("of type float in place of 3 of type int32"));
  EXPECT_THAT(with("\"uint8\"", "\"byte\""), HasSubstr("type \"byte\" is not known"));
  EXPECT_THAT(with("\"size\": 8", "\"size\": 4"), HasSubstr("size does not fit numElements"));
  EXPECT_THAT(with("\"attributes\": [", "\"attributes\": 1, \"x\": ["), HasSubstr("no attribute"));
  EXPECT_THAT(with("\"size\": 1, \"numElements\": 1,", "\"size\": 65535, \"numElements\": 65535,"),
              HasSubstr("more than 65535 bytes"));
  EXPECT_THAT(with("\"numElements\": 1,", "\"numElements\": 1e15,"), HasSubstr("does not fit"));
}

TEST_F(PotreeDamage, OfTheHierarchyIsNamed) {
  const std::size_t proxy = first_of(2);
  const auto first = "\"firstChunkSize\": ";
  EXPECT_THAT(with(first, "\"firstChunkSize\": 9"), HasSubstr("below r are 9"));
  EXPECT_THAT(with(first, "\"firstChunkSize\": 0, \"x\": "), HasSubstr("below r are 0 bytes"));
  EXPECT_THAT(with(first, "\"firstChunkSize\": 22, \"x\": "), HasSubstr("below r end before r0"));
  EXPECT_THAT(with_number(0, 0, std::uint8_t{3}), HasSubstr("bin, byte 0: a node of type 3"));
  EXPECT_THAT(with_number(0, 0, std::uint8_t{2}), HasSubstr("a proxy that stands for itself"));
  EXPECT_THAT(with_number(0, 1, std::uint8_t{0}), HasSubstr("a node that is no other's child"));
  EXPECT_THAT(with_number(proxy, 6, std::uint64_t{0}), HasSubstr("are below two nodes")) << "cycle";
  EXPECT_THAT(with_number(proxy, 6, ~std::uint64_t{0}), HasSubstr("of a file of"));
  EXPECT_THAT(with_number(proxy, 14, std::uint64_t{23}), HasSubstr("are 23 bytes"));
  EXPECT_THAT(refusal_of([](PotreeFiles& files) { files.hierarchy.clear(); }),
              HasSubstr("of a file of 0"));
}

TEST_F(PotreeDamage, OfProxiesWithoutEndIsRefused) {
  PotreeFiles files = files_;
  files.hierarchy.clear();
  constexpr std::uint64_t kDepth = 40;  // chunks of a node and a proxy to the next
  for (std::uint64_t i = 0; i < kDepth; ++i) {
    append(files.hierarchy, std::uint16_t{0x0100});  // inner, child 0
    append(files.hierarchy, std::uint32_t{0});
    append(files.hierarchy, std::uint64_t{0});
    append(files.hierarchy, std::uint64_t{0});
    append(files.hierarchy, std::uint16_t{0x0102});  // proxy
    append(files.hierarchy, std::uint32_t{0});
    append(files.hierarchy, 2 * kRecord * (i + 1));
    append(files.hierarchy, std::uint64_t{2 * kRecord});
  }
  const std::string first = "\"firstChunkSize\": ";
  files.metadata.replace(files.metadata.find(first), first.size(), first + "44, \"x\": ");
  EXPECT_THAT(refusal_of(files), HasSubstr("nodes below level 30"));
  overwrite<std::uint64_t>(files.hierarchy, kRecord + 6, kRecord);  // one that overlaps itself
  EXPECT_THAT(refusal_of(files), HasSubstr("a proxy that stands for itself"));
}

TEST_F(PotreeDamage, OfNodesThatTheOctreeCannotHoldIsNamed) {
  const std::size_t node = first_of(0);
  EXPECT_THAT(with_number(node, 6, ~std::uint64_t{0}),
              HasSubstr("octree.bin: ends inside node r:"));
  EXPECT_THAT(with_number(node, 14, ~std::uint64_t{0}), HasSubstr("ends inside node r:"));
  EXPECT_THAT(with_number(node, 6, std::uint64_t{3}), HasSubstr("begins inside another one"));
  EXPECT_THAT(with_number(node, 2, std::uint32_t{101}),
              HasSubstr("node r has 101 points in 2900 bytes, which cannot hold them"));
  EXPECT_EQ(with_number(node, 2, std::uint32_t{99}), "no error") << "duplicates may be dropped";
  EXPECT_EQ(with_number(node, 14, std::uint64_t{0}), "no error") << "a node without bytes";
}

TEST_F(PotreeDamage, OfPackedNodesIsNamed) {
  PotreeFiles files = potree_of(potree_hill(5000), {.packed = true, .in_node = 100});
  EXPECT_EQ(refusal_of(files), "no error");
  PotreeFiles spoilt = files;
  spoilt.octree.replace(30, 40, 40, '\xaa');
  EXPECT_THAT(refusal_of(spoilt), HasSubstr("is damaged: its brotli data do not unpack to"));
  overwrite<std::uint32_t>(files.hierarchy, 2, 99);
  EXPECT_THAT(refusal_of(files), HasSubstr("node r is damaged")) << "fewer points than bytes";
  overwrite<std::uint32_t>(files.hierarchy, 2, 4'000'000'000U);
  EXPECT_THAT(refusal_of(files), HasSubstr("node r has 4000000000 points in"));
}

// Each packed node may have as many points as it says, but not all of them together.
TEST_F(PotreeDamage, OfCountsThatNoBytesCanHoldIsRefused) {
  PotreeFiles files = potree_of(potree_hill(5000), {.packed = true, .levels = 20, .in_node = 500});
  for (std::size_t at = 0; at < files.hierarchy.size(); at += kRecord) {
    overwrite<std::uint32_t>(files.hierarchy, at + 2, 1'000'000);
  }
  const std::string points = "\"points\": 5000";
  files.metadata.replace(files.metadata.find(points), points.size(), "\"points\": 5000000000");
  EXPECT_THAT(refusal_of(files), testing::ContainsRegex("octree.bin: [0-9]+000000 points in"));
}

// A store that is cut anywhere is refused, as nothing of it can be left out.
TEST_F(PotreeDamage, OfEveryCutIsFound) {
  for (const bool packed : {false, true}) {
    const PotreeFiles files =
        potree_of(potree_hill(800), {.packed = packed, .levels = 2, .in_node = 20});
    const std::pair<const char*, const std::string*> parts[] = {{"metadata.json", &files.metadata},
                                                                {"hierarchy.bin", &files.hierarchy},
                                                                {"octree.bin", &files.octree}};
    ASSERT_EQ(refusal_of(files), "no error");
    for (const auto& [name, bytes] : parts) {
      for (std::size_t size = 0; size < bytes->size(); size += 97) {
        folder_.write(name, bytes->substr(0, size));
        ASSERT_NE(refusal(), "no error") << name << " of " << size << " bytes";
      }
      folder_.write(name, *bytes);
    }
  }
}

TEST_F(PotreeDamage, OfAbsentFilesIsNamed) {
  EXPECT_THAT(refusal(), HasSubstr("no Potree store"));
  folder_.write("metadata.json", files_.metadata);
  EXPECT_THAT(refusal(), HasSubstr("hierarchy.bin: no such file"));
  folder_.write("hierarchy.bin", files_.hierarchy);
  EXPECT_THAT(refusal(), HasSubstr("octree.bin: no such file"));
  folder_.write("octree.bin", files_.octree);
  EXPECT_EQ(refusal(), "no error");
}

}  // namespace
}  // namespace palpate
