// Checks what becomes of the points of blocks that the depth filter kept.
#include <gtest/gtest.h>

#include <memory>

#include "sim/simulated_noise.hpp"
#include "stream/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3f;

// Feeds noisy frames of one camera through one filter, as a source does.
class KeptPoints : public testing::Test {
 protected:
  void show(const test::DepthOf& depth_of) {
    frame_ = test::frame_of(test::small_camera(), 0, depth_of);
    const CameraModel& camera = frame_.camera;
    SimulatedNoise({}).apply(camera.width, camera.height, count_, frame_.depth);
    repeat();
  }

  // Shows the last frame again.
  void repeat() {
    frame_.stamp = ++count_ * interval_;
    depth_ = &filter_.filter(frame_, test::looking_down());
    before_ = points_;
    points_ = std::make_shared<SurfacePoints>();
    const MorphInput input{*depth_, frame_.camera.pinhole};
    morph_.look(input);
    morph_.fill(input, {frame_.stamp, frame_.stamp, interval_}, points_);
  }

  void settle() {
    for (int k = 0; k < 90; ++k) show(test::wall(0.5));
  }

  // Points that stand where they stood, of those that do.
  [[nodiscard]] double share_at_rest() const {
    if (points_->size() != before_->size()) return 0;
    std::size_t rest = 0;
    for (std::size_t i = 0; i < points_->size(); ++i) {
      const Vector3f& end = points_->end_positions[i];
      const bool same = end == before_->end_positions[i] &&
                        points_->end_normals[i] == before_->end_normals[i] &&
                        points_->end_radii[i] == before_->end_radii[i];
      rest += same && end == points_->grid.points()[i] ? 1 : 0;
    }
    return double(rest) / double(points_->size());
  }

  [[nodiscard]] double kept() const {
    double sum = 0;
    for (const std::uint8_t flag : depth_->kept.flags) sum += flag;
    return sum / double(depth_->kept.flags.size());
  }

  DepthFilter filter_{DepthFilterOptions{.noise = kinect_like_noise()}};
  const FilteredDepth* depth_ = nullptr;
  Morph morph_{{}};
  std::shared_ptr<SurfacePoints> points_;
  std::shared_ptr<SurfacePoints> before_;
  DepthFrame frame_;
  std::uint64_t count_ = 0;
  double interval_ = kFrame;
};

TEST_F(KeptPoints, StandWhereTheyStood) {
  settle();
  show(test::wall(0.5));
  EXPECT_GT(kept(), 0.4);
  EXPECT_GT(share_at_rest(), 0.9 * kept());
}

TEST_F(KeptPoints, MoveAtOnceWithWhatTheyShow) {
  settle();
  show(test::wall(0.49));
  EXPECT_EQ(kept(), 0);
  EXPECT_LT(share_at_rest(), 0.01);
  double mean = 0;
  for (const Vector3f& end : points_->end_positions) mean += points_->origin.z() + end.z();
  EXPECT_NEAR(mean / double(points_->size()), 0.01, 1e-3);
}

TEST_F(KeptPoints, LeaveWithWhatTheyShow) {
  settle();
  const std::size_t count = points_->size();
  for (int k = 0; k < 90; ++k) {
    show([](double x, double) { return x < 0 ? 0.5 : 0.8; });
  }
  EXPECT_NEAR(double(points_->size()), double(count), 0.05 * double(count));
  std::size_t low = 0;
  for (const Vector3f& end : points_->end_positions) low += points_->origin.z() + end.z() < -0.2;
  EXPECT_NEAR(double(low) / double(points_->size()), 0.5, 0.1);
}

// A camera of 60 Hz settles on a hole before its points have begun to fade.
TEST_F(KeptPoints, FadeOverAHole) {
  interval_ = 1 / 60.0;
  settle();
  const std::size_t count = points_->size();
  const auto with_hole = [](double x, double y) { return std::hypot(x, y) < 0.05 ? 0 : 0.5; };
  for (int k = 0; k < 120; ++k) show(with_hole);
  EXPECT_LT(points_->size(), count - 200);
  for (const Vector3f& end : points_->end_positions) {
    EXPECT_GT((points_->origin.head<2>() + end.head<2>().cast<double>()).norm(), 0.02);
  }
}

// What jumps goes there in several frames, though each says the same.
TEST_F(KeptPoints, ArriveWhenAFrameComesAgain) {
  settle();
  show(test::wall(0.473));
  for (int k = 0; k < 10; ++k) repeat();
  double mean = 0;
  for (const Vector3f& end : points_->end_positions) mean += points_->origin.z() + end.z();
  EXPECT_NEAR(mean / double(points_->size()), 0.027, 1e-3);
}

}  // namespace
}  // namespace palpate
