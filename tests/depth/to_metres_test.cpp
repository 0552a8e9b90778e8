#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate {
namespace {

using testing::HasSubstr;

std::vector<float> metres(const std::vector<std::uint16_t>& samples, double unit) {
  std::vector<float> depth(samples.size(), -1.0F);
  to_metres(samples, unit, depth);
  return depth;
}

std::string refusal(double unit, std::size_t samples, std::size_t depths) {
  std::vector<float> depth(depths, -1.0F);
  try {
    to_metres(std::vector<std::uint16_t>(samples, 1000), unit, depth);
  } catch (const Error& error) {
    EXPECT_EQ(depth, std::vector<float>(depths, -1.0F));
    return error.what();
  }
  return "none";
}

TEST(ToMetres, TakesAnyUnit) {
  EXPECT_EQ(metres({1, 700, 10000}, 1e-3), (std::vector<float>{0.001F, 0.7F, 10.0F}));
  EXPECT_EQ(metres({1, 7000}, 1e-4), (std::vector<float>{0.0001F, 0.7F}));
  EXPECT_EQ(metres({5000, 2500}, 1.0 / 5000), (std::vector<float>{1.0F, 0.5F}));
  EXPECT_TRUE(metres({}, 1e-3).empty());
}

// Nearest to the true value, whatever the unit: one rounding, to float.
TEST(ToMetres, RoundsOnce) {
  for (int sample = 1; sample < 65535; ++sample) {
    const auto exact = static_cast<float>(1e-3 * sample);
    ASSERT_EQ(metres({static_cast<std::uint16_t>(sample)}, 1e-3)[0], exact);
  }
}

TEST(ToMetres, NothingMeasuredStaysNothing) {
  EXPECT_EQ(metres({0, 1, 65534, 65535}, 1e-3), (std::vector<float>{0, 0.001F, 65.534F, 0}));
}

TEST(ToMetres, RefusesUnitsThatAreNone) {
  for (const double unit : {0.0, -1e-3, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_THAT(refusal(unit, 4, 4), HasSubstr("0.001 for millimetres")) << unit;
  }
  EXPECT_THAT(refusal(-2, 4, 4), HasSubstr("unit of -2 m"));
}

TEST(ToMetres, RefusesOtherSizes) {
  EXPECT_THAT(refusal(1e-3, 4, 3), HasSubstr("4 samples for 3 depths"));
  EXPECT_THAT(refusal(1e-3, 0, 1), HasSubstr("0 samples for 1 depths"));
}

}  // namespace
}  // namespace palpate
