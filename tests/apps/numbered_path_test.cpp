#include <gtest/gtest.h>

#include "apps/palpate/cli/output.hpp"

namespace palpate::app {
namespace {

TEST(NumberedPath, OfTheFirstHandIsAsItIsAndOthersHaveTheirNumberBeforeTheExtension) {
  EXPECT_EQ(numbered_path("forces.csv", 0), "forces.csv");
  EXPECT_EQ(numbered_path("forces.csv", 1), "forces-2.csv");
  EXPECT_EQ(numbered_path("../runs/a.b.csv", 2), "../runs/a.b-3.csv");
  EXPECT_EQ(numbered_path("/tmp/forces", 3), "/tmp/forces-4");
  EXPECT_EQ(numbered_path("", 1), "") << "none is asked for";
}

}  // namespace
}  // namespace palpate::app
