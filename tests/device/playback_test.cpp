#include "palpate/device/playback.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(Playback, IsStraightBetweenRowsAndRestsBeforeAndAfterThem) {
  Playback way({{1, {0, 0, 0}}, {1.5, {0.1, 0, 0}}, {3.5, {0.1, 0.4, 0}}});
  EXPECT_EQ(way.at(-1), Vector3d(0, 0, 0));
  EXPECT_NEAR((way.at(1.25) - Vector3d(0.05, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((way.at(2) - Vector3d(0.1, 0.1, 0)).norm(), 0, 1e-15);
  EXPECT_EQ(way.at(9), Vector3d(0.1, 0.4, 0));
  EXPECT_EQ(way.end(), 3.5);
  way.rewind();
  EXPECT_NEAR((way.at(1.25) - Vector3d(0.05, 0, 0)).norm(), 0, 1e-15);
}

TEST(Playback, OneRowIsAPlaceAndNoRowIsNone) {
  Playback place({{2, {1, 2, 3}}});
  EXPECT_EQ(place.at(0), Vector3d(1, 2, 3));
  EXPECT_EQ(place.at(5), Vector3d(1, 2, 3));
  EXPECT_TRUE(Playback().empty());
}

}  // namespace
}  // namespace palpate
