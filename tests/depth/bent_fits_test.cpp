// Fits on a ball: at an angle, and at its rim before something else.
#include <gtest/gtest.h>

#include <cmath>

#include "base/numbers.hpp"
#include "depth/small_frames.hpp"
#include "depth/window_errors.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// Errors of a ball's blocks that are seen at `low` to `high` degrees.
Errors errors_on_a_ball(const depth::BlockFits& fits, const Solid& ball, double low, double high) {
  Errors errors;
  for (int row = 2; row < fits.grid.rows - 2; ++row) {
    for (int column = 2; column < fits.grid.columns - 2; ++column) {
      const std::size_t i = fits.grid.index(column, row);
      if (fits.states[i] != FilteredDepth::State::fitted) continue;
      const Vector3d position = position_of(fits, column, row);
      const Distance exact = distance_and_normal(ball, position);
      const double angle = std::acos(-exact.gradient.dot(position.normalized())) / kDegree;
      if (std::abs(exact.value) > 2e-3 || angle < low || angle > high) continue;
      errors.add(ball, position, normal_of(fits, column, row));
    }
  }
  return errors;
}

// A ball seen at an angle is no parabola in the image: its third derivatives are not zero.
TEST(BentFits, AreTrueOnABallThatIsSeenAtAnAngle) {
  const Solid ball = sphere({0, 0, 0.66}, 0.06);
  const NoiseModel noise = kinect_like_noise();
  const depth::BlockFits fits = fit_all(blocks_of(exact_frame({ball}), noise), noise);
  const Errors face_on = errors_on_a_ball(fits, ball, 5, 20);
  const Errors aside = errors_on_a_ball(fits, ball, 20, 40);
  ASSERT_GT(face_on.count, 50);
  ASSERT_GT(aside.count, 50);
  EXPECT_LT(face_on.rms_angle(), 0.1 * kDegree);
  EXPECT_LT(aside.rms_angle(), 0.15 * kDegree);
}

// A parabola goes through any three rows, one of what is behind among them.
TEST(BentFits, TakeNoRowOfWhatIsBehindForABend) {
  const NoiseModel noise = kinect_like_noise();
  const Solid wall = plane({0, 0, 1.1}, {0, 0, -1});
  for (int part = 0; part < 8; ++part) {  // of a row of blocks
    const Solid ball = sphere({0, 0.0003 * part, 0.66}, 0.06);
    const depth::BlockFits fits = fit_all(blocks_of(exact_frame({ball, wall}), noise), noise);
    const Errors rim = errors_on_a_ball(fits, ball, 65, 78);
    ASSERT_GT(rim.count, 100);
    EXPECT_LT(rim.rms_angle(), 2.5 * kDegree) << part;
    EXPECT_LT(rim.worst, 12 * kDegree) << part;
  }
}

}  // namespace
}  // namespace palpate::test
