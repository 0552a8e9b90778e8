// LAZ files of others and of the tests' own encoder give the points that laz-perf (npm) gives.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "io/formats.hpp"
#include "io/laz_encoder.hpp"
#include "io/laz_survey.hpp"
#include "support/peer_test.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

std::string file_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class LazPeer : public test::PeerTest {
 protected:
  LazPeer() : PeerTest("laz-perf") {}

  // The records that laz-perf reads from LAZ files.
  [[nodiscard]] std::vector<std::string> records_of(const std::vector<std::string>& files) const {
    std::string names;
    for (std::size_t i = 0; i < files.size(); ++i) {
      folder_.write(fmt::format("{}.laz", i), files[i]);
      names += fmt::format(" {}", folder_ / fmt::format("{}.laz", i));
    }
    (void)run("laz.mjs", names);
    std::vector<std::string> records;
    for (std::size_t i = 0; i < files.size(); ++i) {
      records.push_back(folder_.read(fmt::format("{}.laz.records", i)));
    }
    return records;
  }
};

// Every point is that of the record which is not compressed.
void expect_points(const std::string& laz, const std::string& records) {
  const ReadOptions options;
  const io::Input input{std::as_bytes(std::span(laz)), "a.laz", options};
  const io::LasHeader header = io::read_las_header(input);
  const auto points = io::laz::read_points(input, header);
  ASSERT_EQ(records.size(), header.points * header.record_size);
  const std::byte* record = std::as_bytes(std::span(records)).data();
  for (std::size_t i = 0; i < header.points; ++i, record += header.record_size) {
    const io::LasPoint expected = io::las_point(header, record);
    ASSERT_EQ(points[i].number, expected.number) << i;
    ASSERT_EQ(points[i].intensity, expected.intensity) << i;
    ASSERT_EQ(points[i].color, expected.color) << i;
    ASSERT_EQ(points[i].withheld, expected.withheld) << i;
  }
}

TEST_F(LazPeer, ReadsTheRealFilesAsWeDo) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA names no folder with the real data";
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(fs::path(data) / "pdal_small")) {
    if (entry.path().extension() == ".laz") files.push_back(file_bytes(entry.path()));
  }
  ASSERT_GE(files.size(), 3u);
  const std::vector<std::string> records = records_of(files);
  for (std::size_t i = 0; i < files.size(); ++i) expect_points(files[i], records[i]);
}

TEST_F(LazPeer, ReadsTheFilesOfOurEncoderAsWeDo) {
  std::vector<std::string> files;
  std::vector<std::string> originals;
  for (const int format : {0, 1, 2, 3, 6, 7, 8}) {
    for (const std::size_t extra : {0, 5}) {
      for (const LazWriting& writing :
           {LazWriting{}, LazWriting{.chunk = 700, .varying = true}, LazWriting{.chunk = 999}}) {
        originals.push_back(survey_of({.format = format, .points = 6000, .extra = extra}));
        files.push_back(laz_of(originals.back(), writing));
      }
    }
  }
  const std::vector<std::string> records = records_of(files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    SCOPED_TRACE(fmt::format("file {}", i));
    const std::string_view las = originals[i];
    const std::size_t same = static_cast<std::size_t>(
        std::ranges::mismatch(records[i], las.substr(load<std::uint32_t>(las, 96))).in1 -
        records[i].begin());
    const std::size_t size = load<std::uint16_t>(las, 105);
    EXPECT_EQ(records[i].size(), 6000 * size);
    EXPECT_EQ(same, records[i].size()) << "record " << same / size << ", byte " << same % size;
    expect_points(files[i], records[i]);
  }
}

}  // namespace
}  // namespace palpate
