// Splats in each format: what is read is what was written, and damage is refused.
#include "io/splats/splats.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "io/reading.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/spacing.hpp"
#include "support/splat_files.hpp"
#include "support/splat_scenes.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::Not;

using Reader = io::SplatFile (*)(const io::Input&);

/// A format: how it is written, read and how exact it is.
struct Format {
  std::string name;
  std::function<std::string(std::span<const Splat>)> write;
  Reader read;
  double place = 0.2e-3;  ///< m
  double size = 0.005;    ///< of sigma
  double turn = 0.6;      ///< degrees
};

std::vector<Format> formats() {
  const auto spz = [](int version) {
    return [=](std::span<const Splat> splats) { return test::spz(splats, version); };
  };
  // Scales of .spz come in steps of 1/16 of their logarithm. Rotations of three bytes lose w where
  // it is near 0: half a step of 1/127.5 in x, y, z is 14 degrees there.
  return {{"scene.ply", test::splat_ply, io::read_splat_ply, 1e-8, 1e-5, 0.06},
          {"scene.compressed.ply", test::compressed_splat_ply, io::read_splat_ply},
          {"scene.splat", test::dot_splat, io::read_dot_splat, 1e-8, 1e-6, 1},
          {"1.spz", spz(1), io::read_spz, 0.2e-3, 0.035, 15},
          {"2.spz", spz(2), io::read_spz, 0.25e-3, 0.035, 15},
          {"3.spz", spz(3), io::read_spz, 0.25e-3, 0.035, 0.3},
          {"4.spz", spz(4), io::read_spz, 0.25e-3, 0.035, 0.3}};
}

io::SplatFile read_rows(const Format& format, const std::string& bytes,
                        const ReadOptions& options = {}) {
  return format.read({std::as_bytes(std::span(bytes)), format.name, options});
}

std::vector<Splat> some_splats(int count = 600) {
  return test::make_splats(test::splat_sphere(), {.count = count}, 5);
}

double angle_between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return 2 * std::acos(std::min(1.0, std::abs(a.cast<double>().dot(b.cast<double>())))) / kDegree;
}

TEST(Splats, OfEveryFormatAreThoseThatWereWritten) {
  const std::vector<Splat> splats = some_splats();
  for (const Format& format : formats()) {
    SCOPED_TRACE(format.name);
    const io::SplatFile file = read_rows(format, format.write(splats));
    ASSERT_EQ(file.splats.size(), splats.size());
    EXPECT_EQ(file.dropped, 0u);
    for (std::size_t i = 0; i < splats.size(); ++i) {
      const Splat& read = file.splats[i];
      const Splat& wrote = splats[i];
      ASSERT_LE((read.position - wrote.position).cwiseAbs().maxCoeff(), format.place) << i;
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(read.sigma[k] / wrote.sigma[k], 1, format.size) << i;
      ASSERT_LE(angle_between(read.rotation, wrote.rotation), format.turn) << i;
      ASSERT_NEAR(read.opacity, wrote.opacity, 0.5 / 255 + 1e-6) << i;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(read.color[k], wrote.color[k], 4) << i;
    }
  }
}

TEST(Splats, ScaleIsOfPlacesAndExtents) {
  const std::vector<Splat> splats = some_splats(3);
  for (const Format& format : formats()) {
    const std::string bytes = format.write(splats);
    const Splat plain = read_rows(format, bytes).splats[1];
    const Splat scaled = read_rows(format, bytes, {.scale = 4}).splats[1];
    EXPECT_EQ(scaled.position, 4 * plain.position) << format.name;
    EXPECT_EQ(scaled.sigma, 4 * plain.sigma) << format.name;
  }
}

TEST(Splats, OfTwoScalesAreFlat) {
  std::string bytes = test::splat_ply(some_splats(2));
  bytes.replace(bytes.find("scale_2"), 7, "unknown");
  const io::SplatFile file = read_rows(formats()[0], bytes);
  ASSERT_EQ(file.splats.size(), 2u);
  EXPECT_EQ(file.splats[0].sigma.z(), 0);
  EXPECT_GT(file.splats[0].sigma.y(), 0);
}

TEST(Splats, BecomePointsWithNormalsAndColors) {
  const std::vector<Splat> splats = some_splats(4000);
  const CloudFile plain = read_text(test::splat_ply(splats), "a.ply");
  ASSERT_TRUE(plain.splats);
  EXPECT_EQ(plain.declared, 4000u);
  EXPECT_GT(plain.cloud.size(), 1000u);
  EXPECT_EQ(plain.cloud.normals.size(), plain.cloud.size());
  EXPECT_EQ(plain.cloud.colors[0], (std::array<std::uint8_t, 3>{200, 100, 50}));
  for (const Format& format : formats()) {  // one scene has one surface
    const CloudFile file = read_text(format.write(splats), format.name);
    EXPECT_NEAR(double(file.cloud.size()), double(plain.cloud.size()), 0.05 * plain.cloud.size());
    const CellGrid grid(plain.cloud.positions);
    std::vector<float> distances;
    std::vector<CellGrid::Neighbor> nearest;
    for (const Eigen::Vector3f& p : file.cloud.positions) {
      grid.nearest(p, 1, nearest);
      distances.push_back(std::sqrt(nearest[0].squared_distance));
    }
    EXPECT_LT(median(distances), 0.2 * plain.splats->spacing) << format.name;
  }
}

TEST(Splats, ThatAreNotFiniteAreDroppedAndCounted) {
  std::vector<Splat> splats = some_splats(4000);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  splats[17].sigma.x() = std::numeric_limits<float>::infinity();
  splats[18].sigma.y() = nan;
  splats[19].position.z() = nan;
  splats[20].rotation.coeffs().setZero();
  const CloudFile file = read_text(test::splat_ply(splats), "a.ply");
  EXPECT_EQ(file.declared, 4000u);
  EXPECT_EQ(file.dropped, 4u);
  for (Splat& splat : splats) splat.rotation.coeffs().setZero();
  EXPECT_THAT(refusal(test::splat_ply(splats), "a.ply"), HasSubstr("none of the 4000"));
}

TEST(Splats, OfRotationsOfAnyLengthAreTurnedByThem) {
  const Eigen::Vector4f turn(0.1F, -0.7F, 0.5F, 0.5F);
  io::SplatFile file;
  for (const float length : {1e-42F, 1e-30F, 1.F, 1e30F, 3e38F}) {
    file.add({.rotation = Eigen::Quaternionf(length * turn)}, 1);
    ASSERT_EQ(file.dropped, 0U) << length;
    const float error = (file.splats.back().rotation.coeffs() - turn).norm();
    EXPECT_LT(error, length < 1e-37F ? 1e-2F : 1e-6F) << length;
  }
}

TEST(Splats, ThatShowNothingAreRefused) {
  std::vector<Splat> splats = some_splats(300);
  for (Splat& splat : splats) splat.opacity = 0;
  EXPECT_THAT(refusal(test::dot_splat(splats), "a.splat"),
              HasSubstr("no splat of this scene is opaque"));
  splats = some_splats(300);
  for (Splat& splat : splats) splat.sigma.setZero();
  EXPECT_THAT(refusal(test::dot_splat(splats), "a.splat"), HasSubstr("no splat of this scene"));
}

TEST(Splats, CutAnywhereAreRefused) {
  const std::vector<Splat> splats = some_splats(500);
  for (const Format& format : formats()) {
    const std::string bytes = format.write(splats);
    const std::size_t end = bytes.size() - (format.name == "scene.compressed.ply" ? 1 : 0);
    for (std::size_t size = 1; size < end; size += 97) {
      if (format.read == io::read_dot_splat && size % 32 == 0) continue;  // that is a whole file
      EXPECT_NE(refusal(bytes.substr(0, size), format.name), "no error") << format.name << size;
    }
  }
}

TEST(Splats, OfSpzThatIsDamagedSayWhatAndWhere) {
  const std::vector<Splat> splats = some_splats(500);
  const std::string whole = test::spz(splats, 4);
  const auto with = [&]<class T>(std::size_t offset, T value) {
    std::string bytes = whole;
    overwrite(bytes, offset, value);
    return refusal(bytes, "room.spz");
  };
  EXPECT_THAT(with(4, std::uint32_t{5}), HasSubstr("version 5 is newer than this program reads"));
  EXPECT_THAT(with(8, std::uint32_t{0xffffffff}), HasSubstr("4294967295 splats do not fit"));
  EXPECT_THAT(with(8, std::uint32_t{501}), HasSubstr("(positions) ends after 4500 of 4509"));
  EXPECT_THAT(with(13, std::uint8_t{30}), HasSubstr("30 fractional bits"));
  EXPECT_THAT(with(15, std::uint8_t{4}), HasSubstr("4 streams"));
  EXPECT_THAT(with(16, std::uint32_t{0xfffffff0}), HasSubstr("table of streams is at byte"));
  EXPECT_THAT(with(40, ~std::uint64_t{0}), HasSubstr("(positions) ends after"));
  EXPECT_THAT(with(48, ~std::uint64_t{0}), HasSubstr("(positions) ends after"));
  EXPECT_THAT(with(120, std::uint32_t{0}), HasSubstr("(positions) cannot be unpacked"));
  std::string padded = whole + std::string(100'000, '\0');  // 250 times as much is too little
  overwrite(padded, 8, std::uint32_t{5'000'000});
  EXPECT_THAT(refusal(padded, "room.spz"), HasSubstr("5000000 splats do not fit"));
  std::string old = test::spz(splats, 2);
  overwrite(old, 8, std::uint32_t{1} << 31);
  EXPECT_THAT(refusal(old, "room.spz"), HasSubstr("(positions) ends after"));
}

TEST(Splats, OfSpzThatWouldFillMemoryAreRefusedBeforeTheyDo) {
  std::string bytes = test::spz(some_splats(4), 4);
  const std::string zeros(std::size_t{64} << 20, '\0');  // packs to a 10^4th and less
  std::string bomb(ZSTD_compressBound(zeros.size()), '\0');
  bomb.resize(ZSTD_compress(bomb.data(), bomb.size(), zeros.data(), zeros.size(), 19));
  bytes.resize(120);
  overwrite(bytes, 8, static_cast<std::uint32_t>(zeros.size() / 9));
  overwrite(bytes, 40, std::uint64_t{bomb.size()});
  overwrite(bytes, 48, std::uint64_t{zeros.size() / 9 * 9});
  EXPECT_THAT(refusal(bytes + bomb, "room.spz"), HasSubstr("splats do not fit"));
}

TEST(Splats, OfCompressedPlyNeedTheirChunks) {
  std::string bytes = test::compressed_splat_ply(some_splats(300));
  std::string fewer = bytes;
  fewer.replace(fewer.find("chunk 2"), 7, "chunk 1");
  EXPECT_THAT(refusal(fewer, "a.ply"), HasSubstr("1 chunks for 300 splats"));
  bytes.replace(bytes.find("min_scale_x"), 11, "max_scale_q");
  EXPECT_THAT(refusal(bytes, "a.ply"), HasSubstr("without an element \"chunk\""));
}

// max_scale_x of the first of four chunks: 256 splats of 900 become giants.
TEST(Splats, OfAChunkWithADamagedBoundAreLeftOutAndTold) {
  std::string bytes = test::compressed_splat_ply(some_splats(900));
  const CloudFile whole = read_text(bytes, "a.ply");
  EXPECT_EQ(whole.splats->huge + whole.splats->far, 0u);
  const std::size_t scale = bytes.find("end_header\n") + 11 + 9 * sizeof(float);
  overwrite(bytes, scale, 60.F);
  const CloudFile file = read_text(bytes, "a.ply");
  EXPECT_GT(file.splats->huge, 50u);  // others are not even finite
  EXPECT_LE(file.splats->huge + file.dropped, 256u);
  // The median size is now that of the larger third of the others, and so is the cell.
  EXPECT_GT(file.cloud.size(), whole.cloud.size() / 4);
}

TEST(Splats, OfOtherKindsAreRefusedWithTheirRemedy) {
  EXPECT_THAT(refusal("PK\3\4", "x.sog"), HasSubstr("npx @playcanvas/splat-transform x.sog"));
  EXPECT_THAT(refusal("anything", "x.ksplat"), HasSubstr(".ksplat are not read"));
  EXPECT_THAT(refusal(std::string(1003, 'x'), "figure.splat"),
              HasSubstr("1003 bytes are no whole number of 32-byte splats"));
  EXPECT_THAT(refusal("NGSP", "room.spz"), HasSubstr("the header is cut"));
}

TEST(Splats, TellHowFarTheyAreAndGiveUpWhenAsked) {
  const std::string bytes = test::splat_ply(some_splats(4000));
  std::vector<double> told;
  (void)read_text(bytes, "a.ply", {.progress = [&](double done) { told.push_back(done); }});
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_GT(told.size(), 20u);
  EXPECT_EQ(told.back(), 1);
  int calls = 0;
  const ReadOptions options{.progress = [&](double done) {
    if (done > 0.5) throw std::runtime_error("enough");
    ++calls;
  }};
  EXPECT_THROW((void)read_text(bytes, "a.ply", options), std::runtime_error);
  EXPECT_GT(calls, 0);
}

}  // namespace
}  // namespace palpate
