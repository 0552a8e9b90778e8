// strtod() reads numbers as from_chars() does, which some C++ libraries lack.
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "base/parse_number.hpp"

namespace palpate::test {
namespace {

struct Text {
  std::string_view text;
  std::ptrdiff_t taken;  // characters
  double value;          // 7: left as it was
  std::errc error = {};
};

constexpr double kInfinite = std::numeric_limits<double>::infinity();

constexpr Text kTexts[] = {
    {"", 0, 7, std::errc::invalid_argument},
    {"-", 0, 7, std::errc::invalid_argument},
    {"+1", 0, 7, std::errc::invalid_argument},
    {"-+1", 0, 7, std::errc::invalid_argument},
    {"--1", 0, 7, std::errc::invalid_argument},
    {" 1", 0, 7, std::errc::invalid_argument},
    {"- 1", 0, 7, std::errc::invalid_argument},
    {"x", 0, 7, std::errc::invalid_argument},
    {".", 0, 7, std::errc::invalid_argument},
    {"1e999", 5, 7, std::errc::result_out_of_range},
    {"-1e999", 6, 7, std::errc::result_out_of_range},
    {"1e-999", 6, 7, std::errc::result_out_of_range},
    {"0", 1, 0},
    {"-0", 2, -0.0},
    {"1.5 2", 3, 1.5},
    {"1,5", 1, 1},
    {".5", 2, 0.5},
    {"5.", 2, 5},
    {"-1.25e-3x", 8, -1.25e-3},
    {"1e", 1, 1},
    {"1e+", 1, 1},
    {"1D3", 1, 1},
    {"0x10", 1, 0},
    {"-0X1", 2, -0.0},
    {"4.9406564584124654e-324", 23, 4.9406564584124654e-324},
    {"2.2250738585072011e-308", 23, 2.2250738585072011e-308},
    {"9007199254740993", 16, 9007199254740992},
    {"inf", 3, kInfinite},
    {"-INFINITY", 9, -kInfinite},
    {"1.#INF", 2, 1},
};

TEST(NumberByStrtod, TakesWhatFromCharsTakes) {
  for (const Text& each : kTexts) {
    double value = 7;
    const auto [end, error] = number_by_strtod(each.text, value);
    EXPECT_EQ(error, each.error) << each.text;
    EXPECT_EQ(end - each.text.data(), each.taken) << each.text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(each.value))
        << each.text;
  }
}

TEST(NumberByStrtod, TakesWhatIsNoNumber) {
  for (const std::string_view text : {"nan", "-NaN", "nan(x1)"}) {
    double value = 7;
    const auto [end, error] = number_by_strtod(text, value);
    EXPECT_EQ(error, std::errc{});
    EXPECT_EQ(end, text.data() + text.size());
    EXPECT_TRUE(std::isnan(value));
  }
}

// Behind a token no zero need stand, and a long one is read whole.
TEST(NumberByStrtod, ReadsNoFurtherThanTheText) {
  const std::string digits(5000, '1');
  double value = 7;
  const auto [end, error] = number_by_strtod(std::string_view(digits).substr(0, 3), value);
  EXPECT_EQ(value, 111);
  EXPECT_EQ(end, digits.data() + 3);
  const std::string small = "0." + digits;
  EXPECT_EQ(number_by_strtod(small, value).ptr, small.data() + small.size());
  EXPECT_EQ(value, 1. / 9);
}

// The rounding is the same: parse_number() uses from_chars() where that is.
TEST(NumberByStrtod, RoundsAsParsedNumbersAre) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double any = std::bit_cast<double>(random());
    if (!std::isfinite(any)) continue;
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", 1 + i % 20, any);
    double value = 7;
    const auto [end, error] = number_by_strtod(text, value);
    if (error != std::errc{}) continue;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value),
              std::bit_cast<std::uint64_t>(*parse_number(text)))
        << text;
  }
}

}  // namespace
}  // namespace palpate::test
