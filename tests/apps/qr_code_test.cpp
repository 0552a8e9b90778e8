#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/view/address.hpp"

namespace palpate::app {
namespace {

// One string of '#' and ' ' a row of modules; of half blocks two rows a line.
std::vector<std::string> modules_of(const std::string& text) {
  std::vector<std::string> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::string begin = "\033[30;107m";
    const std::string end = "\033[0m";
    EXPECT_TRUE(line.starts_with(begin) && line.ends_with(end)) << line;
    std::string upper;
    std::string lower;
    for (std::size_t i = begin.size(); i < line.size() - end.size();) {
      const std::string_view rest = std::string_view(line).substr(i);
      const bool full = rest.starts_with("█");
      upper += full || rest.starts_with("▀") ? '#' : ' ';
      lower += full || rest.starts_with("▄") ? '#' : ' ';
      i += rest.front() == ' ' ? 1 : 3;
    }
    rows.insert(rows.end(), {upper, lower});
  }
  return rows;
}

TEST(QrCode, HasItsThreeCornersAndLightAroundIt) {
  const std::string url = "http://192.168.100.200:8420/#0123456789abcdef0123456789abcdef";
  const std::string text = qr_code(url);
  if (text.empty()) GTEST_SKIP() << "built without libqrencode";
  const std::vector<std::string> rows = modules_of(text);
  const std::size_t width = rows.front().size() - 8;
  EXPECT_EQ(width % 4, 1U) << "17 + 4 version";
  const auto corner = [&](std::size_t row, std::size_t column) {
    const std::vector<std::string> finder = {"#######", "#     #", "# ### #", "# ### #",
                                             "# ### #", "#     #", "#######"};
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(rows[row + i].substr(column, 7), finder[i]) << row << ' ' << column << ' ' << i;
    }
  };
  corner(4, 4);
  corner(4, 4 + width - 7);
  corner(4 + width - 7, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows[i], std::string(width + 8, ' '));
    EXPECT_EQ(rows[4 + width + i], std::string(width + 8, ' '));
  }
  EXPECT_NE(text, qr_code(url + "0")) << "it says the address";
  EXPECT_EQ(qr_code(std::string(5000, 'x')), "") << "too much for one";
}

}  // namespace
}  // namespace palpate::app
