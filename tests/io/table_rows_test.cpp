// A row with a value too many or too few is named, in every format of text.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "io/reading.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

constexpr int kRows = 20;

struct RowFormat {
  std::string name;
  std::string separator;
  bool fixed = false;  // the number of columns: 4
};

std::string head_of(const std::string& name, int columns) {
  std::string names = "x";
  for (int k = 1; k < columns; ++k) names += std::string(" ") + "xyzabc"[k];
  if (name == "a.pcd") {
    std::string sizes;
    std::string types;
    for (int k = 0; k < columns; ++k) {
      sizes += " 4";
      types += " F";
    }
    return fmt::format("FIELDS {}\nSIZE{}\nTYPE{}\nWIDTH {}\nHEIGHT 1\nDATA ascii\n", names, sizes,
                       types, kRows);
  }
  if (name == "a.ply") {
    std::string head = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", kRows);
    for (int k = 0; k < columns; ++k) head += fmt::format("property float {}\n", "xyzabc"[k]);
    return head + "end_header\n";
  }
  if (name == "a.ptx") {
    return fmt::format("1\n{}\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
                       kRows);
  }
  if (name == "a.pts") return fmt::format("{}\n", kRows);
  return "# a table\n";
}

// A table whose row `odd` has `more` values more than the others.
std::string table_of(const RowFormat& format, int columns, int odd, int more,
                     std::mt19937& random) {
  std::string text = head_of(format.name, columns);
  std::uniform_real_distribution<double> value(-5, 5);
  for (int i = 0; i < kRows; ++i) {
    const int cells = i == odd ? columns + more : columns;
    for (int k = 0; k < cells; ++k) {
      text += fmt::format("{}{:.4f}", k == 0 ? "" : format.separator, value(random));
    }
    text += "\n";
  }
  return text;
}

TEST(TableRows, ARowOfAnotherLengthIsNamed) {
  const std::vector<RowFormat> formats{{"a.pcd", " "},  {"a.ply", " "},  {"a.ptx", " ", true},
                                       {"a.pts", " "},  {"a.xyz", "\t"}, {"a.csv", ","},
                                       {"a.txt", "; "}, {"b.txt", ", "}};
  for (const RowFormat& format : formats) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      const int columns = format.fixed ? 4 : 3 + static_cast<int>(random() % 4);
      // The first row tells how many values the others have, where no header does.
      const int odd = 1 + static_cast<int>(random() % (kRows - 1));
      const int more = random() % 2 == 0 ? 1 : -1;
      const std::string text = table_of(format, columns, odd, more, random);
      EXPECT_EQ(read_text(table_of(format, columns, -1, 0, random), format.name).cloud.size(),
                static_cast<std::size_t>(kRows));
      const std::string head = head_of(format.name, columns);
      const auto line = std::count(head.begin(), head.end(), '\n') + odd + 1;
      // A last row that is short may as well be cut: then the place is the file's end.
      if (odd == kRows - 1 && more < 0 && format.name != "a.xyz") continue;
      EXPECT_THAT(refusal(text, format.name),
                  HasSubstr(fmt::format("{}, line {}: {} values in a row", format.name, line,
                                        columns + more)))
          << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace palpate
