#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "io/reading.hpp"
#include "support/counts.hpp"

namespace palpate {
namespace {

using test::count_short_of_bits;
using test::kLargestCount;
using testing::HasSubstr;

std::string npy(const std::string& header, std::string_view data, int version = 1) {
  std::string bytes = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
  const auto size = static_cast<std::uint32_t>(header.size());
  if (version == 1) append(bytes, static_cast<std::uint16_t>(size));
  if (version != 1) append(bytes, size);
  return bytes + header + std::string(data);
}

std::string header(const std::string& type, const std::string& shape) {
  return "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
}

template <class T>
std::string numbers(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) append(bytes, value);
  return bytes;
}

const std::string kSix = numbers<float>({1, 2, 3, 4, 5, 6});

TEST(Npy, ReadsRowsOfPoints) {
  for (const int version : {1, 2, 3}) {
    const CloudFile file = read_text(npy(header("<f4", "(2, 3)"), kSix, version), "a.npy");
    ASSERT_EQ(file.cloud.size(), 2u);
    EXPECT_EQ(file.format, "NumPy array");
    EXPECT_EQ(file.cloud.point(1), Eigen::Vector3d(4, 5, 6));
  }
  const CloudFile four =
      read_text(npy(header("<f8", "(1, 4)"), numbers<double>({1, 2, 3, 0.5})), "cloud");
  EXPECT_EQ(four.cloud.intensities[0], 0.5F);
  const CloudFile six =
      read_text(npy(header("<i2", "(1, 6)"), numbers<std::int16_t>({1, 2, 3, 255, 0, 9})));
  EXPECT_EQ(six.cloud.colors[0], (std::array<std::uint8_t, 3>{255, 0, 9}));
  EXPECT_THAT(read_text(npy(header("<f4", "(1, 3)"), kSix)).format, HasSubstr("1 more"));
}

TEST(Npy, SaysThatRowsOfNineMayAsWellBeColumns) {
  std::string data;
  for (int i = 0; i < 27; ++i) append(data, static_cast<float>(i));
  const CloudFile file = read_text(npy(header("<f4", "(3, 9)"), data), "a.npy");
  EXPECT_EQ(file.cloud.size(), 3u);
  EXPECT_THAT(file.format, HasSubstr("its rows taken for points: save a.T if"));
  EXPECT_EQ(read_text(npy(header("<f4", "(9, 3)"), data), "a.npy").format, "NumPy array");
}

TEST(Npy, FindsTheAxisOfThePoint) {
  const auto second = [](const std::string& shape) {
    return Eigen::Vector3d(read_text(npy(header("<f4", shape), kSix), "a.npy").cloud.point(1));
  };
  for (const char* shape : {"(2, 3)", "(1, 2, 3)", "(2, 1, 3)", "(2, 3, 1)"}) {
    EXPECT_EQ(second(shape), Eigen::Vector3d(4, 5, 6)) << shape;
  }
  for (const char* shape : {"(3, 2)", "(1, 3, 2)", "(3, 1, 2)", "(3, 2, 1, 1)"}) {
    EXPECT_EQ(second(shape), Eigen::Vector3d(2, 4, 6)) << shape;
  }
  const CloudFile file = read_text(npy(header("<f4", "(3, 2)"), kSix));
  EXPECT_EQ(file.format, "NumPy array, its axis of 3 taken for x y z");
  std::string middle;  // two batches of three channels of two
  for (int i = 0; i < 12; ++i) append(middle, static_cast<float>(i));
  const CloudFile batches = read_text(npy(header("<f4", "(2, 3, 2)"), middle));
  EXPECT_EQ(batches.cloud.point(1), Eigen::Vector3d(1, 3, 5));
  EXPECT_EQ(batches.cloud.point(2), Eigen::Vector3d(6, 8, 10));
  const std::string wide = npy(header("<f4", "(2, 6)"), middle);
  EXPECT_EQ(read_text(wide).format, "NumPy array");
  const std::string five = npy(header("<f4", "(2, 5)"), middle.substr(0, 40));
  EXPECT_EQ(read_text(five).format, "NumPy array, the first 3 of 5 columns");
}

TEST(Npy, ReadsFortransOrder) {
  std::string text = header("<f4", "(2, 3)");
  text.replace(text.find("False"), 5, "True");
  EXPECT_EQ(read_text(npy(text, kSix)).cloud.point(1), Eigen::Vector3d(2, 4, 6));
}

TEST(Npy, SaysHowToSaveWhatItDoesNotRead) {
  EXPECT_THAT(refusal(npy(header("<f2", "(2, 3)"), kSix)), HasSubstr("a.astype('<f8')"));
  EXPECT_THAT(refusal(npy(header(">f4", "(2, 3)"), kSix)), HasSubstr("a.astype('<f8')"));
  EXPECT_THAT(refusal(npy(header("<c16", "(2, 3)"), kSix)), HasSubstr("Save the points alone"));
  EXPECT_THAT(refusal(npy(header("<f4", "(3, 2, 2)"), kSix)),
              HasSubstr("ends after 2 of 4 points"));
  EXPECT_THAT(refusal(npy(header("<f4", "(900, 2)"), kSix)), HasSubstr("three numbers a point"));
  EXPECT_THAT(refusal(npy(header("<f4", "(2, 900)"), kSix)), HasSubstr("three numbers a point"));
  EXPECT_THAT(refusal(npy(header("|u1", "(48, 64, 3)"), kSix)), HasSubstr("a picture of bytes"));
  EXPECT_THAT(refusal(npy(header("<f4", "(6,)"), kSix)), HasSubstr("a.reshape(-1, 3)"));
  EXPECT_THAT(refusal(npy("{'descr': [('x', '<f4'), ('y', '<f4'), ('z', '<f4')], "
                          "'fortran_order': False, 'shape': (2,), }\n",
                          kSix)),
              HasSubstr("np.stack([a[k] for k in ('x', 'y', 'z')], -1)"));
}

TEST(Npy, SaysWhatIsDamaged) {
  const std::string whole = npy(header("<f4", "(2, 3)"), kSix);
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 1)), HasSubstr("ends after 1 of 2 points"));
  EXPECT_THAT(refusal(whole.substr(0, 40)), HasSubstr("ends within its header"));
  EXPECT_THAT(refusal(npy("{}\n", kSix)), HasSubstr("no array of rows"));
  EXPECT_THAT(refusal(npy(header("<f4", "(" + kLargestCount + ", 3)"), kSix)),
              HasSubstr("ends after 2 of "));
  EXPECT_THAT(refusal(npy(header("<f4", "(4, " + count_short_of_bits(2) + ")"), kSix)),
              HasSubstr("ends after 1 of "));
  EXPECT_THAT(refusal(npy(header("<f4", "(0, 3)"), "")), HasSubstr("holds no points"));
}

TEST(Kitti, ReadsPointsOfFourFloats) {
  const std::string bytes = numbers<float>({1, -2, 3, 0.5F, 4, 5, 6, 0});
  const CloudFile file = read_text(bytes, "0.bin");
  ASSERT_EQ(file.cloud.size(), 2u);
  EXPECT_EQ(file.cloud.point(0), Eigen::Vector3d(1, -2, 3));
  EXPECT_EQ(file.cloud.intensities[0], 0.5F);
  EXPECT_EQ(read_text("1 2 3\n", "0.bin").format, "text");
}

TEST(Kitti, RefusesWhatGoesFromPointToPointInOtherGroups) {
  for (const int wide : {3, 5, 6}) {
    std::string bytes;
    for (int i = 0; i < 400; ++i) {
      for (int k = 0; k < wide; ++k)
        append(bytes, 10.F * static_cast<float>(k) + 0.01F * static_cast<float>(i));
    }
    EXPECT_THAT(refusal(bytes, "scan.bin"), HasSubstr(std::to_string(wide) + " floats")) << wide;
  }
  EXPECT_THAT(refusal(numbers<double>({1.1, 2.2, 3.3, 4.4, 5.5, 6.6}), "scan.bin"),
              HasSubstr("3 doubles"));
}

TEST(Kitti, RefusesOtherGroupsOfFloats) {
  for (const std::string& bytes :
       {kSix, numbers<float>({1, 2, 3, 4, 0, 5, -6, -7}), numbers<float>({1, 2, INFINITY, 4})}) {
    EXPECT_THAT(refusal(bytes, "0.bin"), HasSubstr("np.fromfile")) << bytes.size();
  }
  EXPECT_THAT(refusal(numbers<float>({1, 2, 3, 4, 5, 6, 7, -8}), "0.bin"), HasSubstr("byte 28"));
}

TEST(Pfm, IsToldHowToBecomeDepth) {
  EXPECT_THAT(refusal("Pf\n2 2\n-1.0\n" + kSix, "a.pfm"), HasSubstr("16-bit PGM of millimetres"));
}

}  // namespace
}  // namespace palpate
