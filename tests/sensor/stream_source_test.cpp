// From a camera to a surface that can be touched.
#include <gtest/gtest.h>

#include <limits>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "palpate/sensor/stream.hpp"
#include "sensor/fake_camera.hpp"
#include "sensor/folder.hpp"

namespace palpate {
namespace {

using namespace sensor;

// Plates that face the camera at 1 m, 1.001 m, ..., 64 x 48 pixels at 30 Hz.
void write_plates(const Folder& folder, int frames) {
  folder.write("sequence.json",
               R"({"fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "invalid": [0], "fps": 30})");
  for (int i = 0; i < frames; ++i) {
    folder.write("depth/" + std::to_string(i) + ".pgm",
                 pgm(static_cast<std::uint16_t>(1000 + i), 64, 48));
  }
}

TEST(StreamSource, MakesFramesASurface) {
  const Folder folder;
  write_plates(folder, 6);
  ManualClock clock;
  Scene scene;
  Source& source = scene.add("camera");
  SceneField field(scene);
  const Eigen::Vector3d hand(0, 0, 0.98);
  field.update_from(0, hand, hand);
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
  const auto camera = open_camera("sequence:" + folder.path().string());
  const Stream stream(*camera, source, clock);
  ASSERT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
  const StreamState state = stream.state();
  EXPECT_EQ(state.frames, 6u);
  EXPECT_EQ(state.touchable, 6u);
  EXPECT_EQ(state.drops.total(), 0u) << state.problem;
  EXPECT_TRUE(state.problem.empty()) << state.problem;
  field.update_from(1, hand, hand);
  EXPECT_FALSE(has(field.notes(), FieldNote::no_surface));
  EXPECT_GT(field.patch_points(), 0u);
  EXPECT_EQ(field.surface({0, 0, 1.0}).source, 0);
}

TEST(StreamSource, MakesFramesTheSameSurfaceInSimulatedTime) {
  const Folder folder;
  write_plates(folder, 6);
  Scene scene;
  Source& source = scene.add("camera");
  SceneField field(scene);
  const Eigen::Vector3d hand(0, 0, 0.98);
  const auto camera = open_camera("sequence:" + folder.path().string());
  SimulatedStream stream(*camera, source);
  for (int i = 0; i < 300; ++i) {
    const double now = 1e-3 * i;
    stream.advance(now);
    field.update_from(now, hand, hand);
    EXPECT_EQ(has(field.notes(), FieldNote::no_surface), now < 0.01) << now;
  }
  EXPECT_EQ(stream.state().phase, StreamState::Phase::ended);
  EXPECT_EQ(stream.state().touchable, 6u);
  EXPECT_EQ(field.surface({0, 0, 1.0}).source, 0);
  EXPECT_EQ(source.state().silent_from, std::numeric_limits<double>::infinity());
}

// Where nobody looks any more the recording's last surface stays.
TEST(StreamSource, KeepsWhatARecordingShowedLast) {
  const Folder folder;
  write_plates(folder, 3);
  ManualClock clock;
  Scene scene;
  Source& source = scene.add("camera");
  const auto camera = open_camera("sequence:" + folder.path().string());
  const Stream stream(*camera, source, clock);
  ASSERT_TRUE(eventually([&] { return stream.state().phase == StreamState::Phase::ended; }));
  EXPECT_EQ(source.state().silent_from, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace palpate
