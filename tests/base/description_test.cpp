// Options that are described are checked by their ranges, and found by their keys.
#include "base/description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate {

enum class Speed { slow, quick };
[[nodiscard]] constexpr auto choices(Speed /*of*/) {
  return std::array<Named<Speed>, 2>{{{"slow", Speed::slow}, {"quick", Speed::quick}}};
}

struct Wheel {
  double size = 1;
};
template <EitherConst<Wheel> Options>
void describe(Options& options, const auto& take) {
  auto& [size] = options;
  take(About{.name = "size", .unit = "m", .range = kPositive}, size);
}

struct Cart {
  int wheels = 4;
  std::optional<double> load = {};
  Speed speed = Speed::slow;
  Wheel wheel = {};
  double reach = 1;
};
template <EitherConst<Cart> Options>
void describe(Options& options, const auto& take) {
  auto& [wheels, load, speed, wheel, reach] = options;
  take(About{.name = "wheels", .range = {.least = 2, .most = 8}}, wheels);
  take(About{.name = "load", .unit = "kg", .range = kNotNegative}, load);
  take(About{.name = "speed"}, speed);
  take(About{.name = "wheel"}, wheel);
  take(About{.name = "reach",
             .unit = "m",
             .range = {.least = 0, .open = true, .words = "a length", .infinity = "all"}},
       reach);
}

namespace {

std::string refusal(const Cart& cart) {
  try {
    check_described("cart", cart);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(Description, WhatIsWithinItsRangePasses) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal({}), "none");
  EXPECT_EQ(refusal({.wheels = 2, .load = 0, .speed = Speed::quick, .reach = infinite}), "none");
  EXPECT_EQ(refusal({.wheels = 8}), "none");
}

TEST(Description, ErrorsNameOptionValueAndRemedy) {
  EXPECT_EQ(refusal({.wheels = 9}), "cart: wheels is 9; give 2 to 8");
  EXPECT_EQ(refusal({.load = -1}), "cart: load (kg) is -1; give a number of 0 or more");
  EXPECT_EQ(refusal({.wheel = {0}}), "cart: wheel.size (m) is 0; give a number above 0");
  EXPECT_EQ(refusal({.reach = -2}), "cart: reach (m) is -2; give a length, or infinity for all");
  EXPECT_EQ(refusal({.speed = static_cast<Speed>(7)}),
            "cart: speed is unknown or removed; give slow, quick");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(refusal({.load = bad}), "none") << bad;
  }
}

TEST(Description, OptionsOfPartsHaveTheNameOfThePartBeforeTheirs) {
  std::vector<std::string> keys;
  const Cart cart;
  each_option(cart,
              [&](const std::string& key, const About&, const auto&) { keys.push_back(key); });
  EXPECT_THAT(keys, testing::ElementsAre("wheels", "load", "speed", "wheel_size", "reach"));
  EXPECT_EQ(described(cart, cart.wheel.size).key, "wheel_size");
  EXPECT_STREQ(described(cart, cart.load).about.unit, "kg");
}

}  // namespace
}  // namespace palpate
