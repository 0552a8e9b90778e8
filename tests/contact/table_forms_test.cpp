// Tables of points are felt alike in whatever form they are written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr int kSide = 30;         // points along either side of the plane, 2 mm apart
constexpr double kSlope = 0.3;    // of the plane along x
constexpr double kHeight = 0.02;  // m, of its middle

Vector3d plane_point(int i) {
  const double x = 0.002 * (i % kSide) - 0.029;
  return {x, 0.002 * (i / kSide) - 0.029, kHeight + kSlope * x};
}

// A hand comes down along the normal onto the middle and presses 1 mm deep.
void expect_pressed(const std::string& bytes, const std::string& name, std::size_t dropped) {
  const CloudFile file = read_cloud_bytes(std::as_bytes(std::span(bytes)), name);
  EXPECT_EQ(file.cloud.size(), static_cast<std::size_t>(kSide * kSide));
  EXPECT_EQ(file.dropped, dropped);
  Scene scene;
  scene.add("table", file.cloud);
  SceneField field(scene);
  Proxy proxy;
  const Vector3d middle(0, 0, kHeight);
  const Vector3d up = Vector3d(-kSlope, 0, 1).normalized();
  Contact contact;
  proxy.reset(middle + 5e-3 * up);
  for (int i = 0; i <= 60; ++i) {
    const Vector3d hip = middle + (5e-3 - 1e-4 * i) * up;
    field.update(kTick * (i + 1), hip, proxy);
    contact = proxy.step(field, hip, kTick);
  }
  ASSERT_TRUE(contact.touching);
  EXPECT_NEAR((contact.proxy - middle).norm(), 0, 1e-5);
  EXPECT_NEAR(contact.force.norm(), contact.stiffness * 1e-3, contact.stiffness * 1e-5);
  EXPECT_GT(contact.force.normalized().dot(up), 0.9999);
}

template <class T>
T one_of(std::mt19937& random, const std::vector<T>& choices) {
  return choices[random() % choices.size()];
}

// How a table of text is written.
struct TextForm {
  std::string separator;
  char decimal = '.';
  std::string header;  // names behind one another, divided by |; empty: none
  std::string before;  // lines before all else
  bool quoted = false;
  bool counted = false;  // a first column counts the rows
  bool gap = false;      // one more row lacks its y
  int first = 0;         // that the first row counts
  std::string exponent = "e";
};

TextForm random_form(std::mt19937& random) {
  TextForm form;
  form.separator = one_of<std::string>(random, {" ", "\t", ";", ",", ", ", "   "});
  form.quoted = random() % 4 == 0;
  if (form.separator != "," || form.quoted) form.decimal = one_of<char>(random, {'.', ','});
  form.counted = random() % 3 == 0;
  form.first = static_cast<int>(random() % 2);
  form.gap = form.separator[0] != ' ' && random() % 2 == 0;
  form.exponent = one_of<std::string>(random, {"e", "E", "D", "d"});
  form.header = one_of<std::string>(
      random, {"", "", "x|y|z", "X[m]|Y[m]|Z[m]", "Easting [m]|Northing [m]|Height [m]",
               "Points:0|Points:1|Points:2", "EASTING|NORTHING|ELEVATION", "//X|Y|Z"});
  if (form.counted && !form.header.empty()) {
    form.header = form.header[0] == '/' ? "//ID|X|Y|Z" : "id|" + form.header;
  }
  if (form.separator == ";" && random() % 2 == 0) form.before = "sep=;\n";
  if (random() % 4 == 0) form.before += "# points of a plane\n";
  return form;
}

std::string cell_of(const TextForm& form, double value) {
  std::string text = fmt::format("{:.7e}", value);
  text.replace(text.find('e'), 1, form.exponent);
  std::ranges::replace(text, '.', form.decimal);
  return form.quoted ? '"' + text + '"' : text;
}

std::string text_of(const TextForm& form) {
  std::string text = form.before;
  std::string names = form.header;
  for (std::size_t at = names.find('|'); at != std::string::npos; at = names.find('|')) {
    names.replace(at, 1, form.separator);
  }
  if (!names.empty()) text += names + "\n";
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vector3d p = plane_point(i);
    if (form.counted) text += std::to_string(i + form.first) + form.separator;
    text += cell_of(form, p.x()) + form.separator + cell_of(form, p.y()) + form.separator +
            cell_of(form, p.z()) + "\n";
  }
  if (!form.gap) return text;
  if (form.counted) text += std::to_string(kSide * kSide + form.first) + form.separator;
  return text + cell_of(form, 9) + form.separator + form.separator + cell_of(form, 9) + "\n";
}

TEST(TableForms, TextOfAnyFormIsFeltAlike) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const TextForm form = random_form(random);
    const std::string text = text_of(form);
    SCOPED_TRACE(fmt::format("seed {}: {}", seed, text.substr(0, 200)));
    expect_pressed(text, "table.txt", form.gap ? 1 : 0);
  }
}

TEST(TableForms, ScansOfOnePtsFileAreFeltTogether) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    std::string text;
    int left = 0;
    for (int i = 0; i < kSide * kSide; ++i, --left) {
      if (left == 0) {
        left = std::min<int>(kSide * kSide - i, 1 + static_cast<int>(random() % 400));
        text += std::to_string(left) + "\r\n";
      }
      const Vector3d p = plane_point(i);
      text += fmt::format("{:.6f} {:.6f} {:.6f} {}\r\n", p.x(), p.y(), p.z(), -1000 + i);
    }
    expect_pressed(text, "scans.pts", 0);
  }
}

TEST(TableForms, LongitudeAndLatitudeAreFeltInMetres) {
  constexpr double kTurn = 6378137 * 3.14159265358979 / 180;  // m a degree along the equator
  for (const char* names : {"lon,lat,height", "Longitude,Latitude,Elevation", "lng,lat,alt"}) {
    std::string text = fmt::format("{}\n", names);
    const auto add = [&](const Vector3d& p) {
      // On the ellipsoid: at the equator a degree of latitude is shorter by its flattening.
      text += fmt::format("{:.12f},{:.12f},{:.6f}\n", -179.9999999 + p.x() / kTurn,
                          p.y() / (kTurn * 0.99330562), p.z());
    };
    // The first point is where x and y are zero.
    add({0, 0, kHeight});
    for (int i = 0; i < kSide * kSide; ++i) {
      if (i != kSide * kSide / 2 + kSide / 2) add(plane_point(i));
    }
    expect_pressed(text, "degrees.csv", 0);
  }
}

template <class T>
void append_number(std::string& out, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  out.append(bytes.data(), bytes.size());
}

std::string npy_of(std::mt19937& random) {
  const int version = 1 + static_cast<int>(random() % 3);
  const bool doubles = random() % 2 == 0;
  const bool fortran = random() % 2 == 0;
  const int columns = one_of<int>(random, {3, 4, 6});
  constexpr int kRows = kSide * kSide;
  std::string header =
      fmt::format("{{'descr': '{}f{}', 'fortran_order': {}, 'shape': ({}, {}), }}", '<',
                  doubles ? 8 : 4, fortran ? "True" : "False", kRows, columns);
  header += std::string(random() % 40, ' ') + "\n";
  std::string bytes = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
  const auto size = static_cast<std::uint32_t>(header.size());
  version == 1 ? append_number(bytes, static_cast<std::uint16_t>(size))
               : append_number(bytes, size);
  bytes += header;
  for (int i = 0; i < kRows * columns; ++i) {
    const int row = fortran ? i % kRows : i / columns;
    const int column = fortran ? i / kRows : i % columns;
    const double value = column < 3 ? plane_point(row)[column] : 0.5;
    doubles ? append_number(bytes, value) : append_number(bytes, static_cast<float>(value));
  }
  return bytes;
}

TEST(TableForms, ArraysOfAnyFormAreFeltAlike) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    expect_pressed(npy_of(random), "array.npy", 0);
  }
}

TEST(TableForms, PointsOfKittiAreFelt) {
  std::string bytes;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vector3d p = plane_point(i);
    for (const double value : {p.x(), p.y(), p.z(), 0.25}) {
      append_number(bytes, static_cast<float>(value));
    }
  }
  expect_pressed(bytes, "000000.bin", 0);
}

}  // namespace
}  // namespace palpate::test
