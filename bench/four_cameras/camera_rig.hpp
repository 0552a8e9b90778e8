#pragma once

#include <memory>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/scene/scene.hpp"
#include "sim/simulated_camera.hpp"

/// The four cameras that four_cameras_bench looks through.
namespace palpate::four_cameras {

constexpr int kCameras = 4;  ///< judgement: a table-top seen from all sides

/// Four simulated cameras at 30 Hz, out of step with each other, that look at the same table from
/// places 10 cm apart. Their frames, 32 each, are made at once and shown over and over, so that
/// making them costs nothing later.
class CameraRig {
 public:
  explicit CameraRig(const Clock& clock);

  [[nodiscard]] SimulatedCamera& camera(int k) { return *cameras_[static_cast<std::size_t>(k)]; }

  /// Sources for the four, in this order.
  static void add_sources(Scene& scene);

  /// Shows every source of `scene` one frame; it stands still then.
  void show_once(Scene& scene);

 private:
  std::vector<std::unique_ptr<SimulatedCamera>> cameras_;
};

}  // namespace palpate::four_cameras
