// Declares the simulated depth camera and its faults in time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sim/simulated_depth.hpp"
#include "sim/simulated_noise.hpp"
#include "sim/simulated_scene.hpp"

namespace palpate {

struct SimulatedCameraOptions {
  std::string name = "simulated";
  CameraModel camera = {640, 480, {525, 525, 319.5, 239.5}, {}};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  SimulatedMotion motion = {};  ///< of the camera
  SimulatedNoiseOptions noise = {};
  double rate = 30;         ///< frames a second, Hz
  double phase = 0;         ///< frame k is taken at start + phase + k / rate + jitter, s
  double jitter = 0;        ///< frames are taken so much too early or too late at most, s
  double dropped = 0;       ///< share of frames that never arrive, 0-1
  double repeated = 0;      ///< share of frames that show the depths of the frame before, 0-1
  double jump = 0;          ///< stamps are so far ahead after half of `frames`, or 100 without, s
  int frames = 0;           ///< after so many, lost ones too, it has ended; 0: never
  int loop = 0;             ///< > 0: so many frames are made beforehand, then shown over and over
  bool report_pose = true;  ///< frames carry their pose
  /// Calibration error: the pose that is reported is the true one times this.
  Eigen::Isometry3d T_camera_reported = Eigen::Isometry3d::Identity();
  const Clock* clock = nullptr;      ///< that it waits for; outlives it. Null: as fast as requested
  std::optional<double> start = {};  ///< on that clock, s; unset: when the camera is opened; 0
                                     ///< without a clock
};

/// Looks at a simulated scene. Stamps are on the clock that it is given; the scene's time is the
/// stamp less the start and less a jump. Frames that nobody requested in time are gone, as with a
/// real camera.
class SimulatedCamera final : public DepthCamera {
 public:
  /// @throws Error when an option is out of its range.
  SimulatedCamera(SimulatedScene scene, const SimulatedCameraOptions& options);

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override;
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;
  [[nodiscard]] std::string reason() const override { return {}; }

  /// The truth.
  [[nodiscard]] const SimulatedScene& scene() const { return scene_; }
  [[nodiscard]] double start() const { return start_; }  ///< stamp of the scene's time 0, s
  /// True pose of the camera at the scene's time t.
  [[nodiscard]] Eigen::Isometry3d true_pose(double t) const;
  /// Exact depths of the frame rendered last, m; not kept up to date while frames are looped.
  [[nodiscard]] const std::vector<float>& exact_depth() const { return exact_; }

 private:
  [[nodiscard]] double stamp_of(std::uint64_t frame) const;
  [[nodiscard]] bool arrives(std::uint64_t frame) const;
  [[nodiscard]] std::uint64_t shown_in(std::uint64_t frame) const;
  [[nodiscard]] bool wait_for_frame(double timeout);
  void make_depth(std::uint64_t number, std::vector<float>& depth);
  void fill(std::uint64_t number, DepthFrame& frame);

  SimulatedScene scene_;
  SimulatedCameraOptions options_;
  CameraInfo info_;
  DepthRenderer renderer_;
  SimulatedNoise noise_;
  double start_ = 0;
  std::uint64_t first_ = 0;  // frame since the camera is open
  std::uint64_t next_ = 0;
  std::vector<float> exact_;
  std::vector<std::vector<float>> loop_;
};

/// A calibration error: the reported pose is off by `meters` to the side and `radians` about an
/// oblique axis, in directions that `seed` picks.
[[nodiscard]] Eigen::Isometry3d calibration_error(double meters, double radians,
                                                  std::uint64_t seed);

/// A scene with a camera that looks at it.
struct SimulatedSetup {
  SimulatedScene scene;
  SimulatedCameraOptions camera;
};

struct SimulatedName {
  std::string name;
  std::string description;  ///< a line for lists
};

/// The scenes that have names.
[[nodiscard]] std::vector<SimulatedName> simulated_names();

/// @throws Error when there is no scene of that name; lists which there are.
[[nodiscard]] SimulatedSetup make_simulated_setup(const std::string& name);

/// Opens "SCENE[,KEY=VALUE]..." ("" is the scene `table`). Keys: noise (none, a, b, c: NoiseKind in
/// their order; structured, stereo, tof: what such sensors do in all, before other keys of noise),
/// sigma (m, at all depths), terraces (SimulatedNoiseOptions::disparity_step), curl, mixed,
/// pattern, correlation, smoothing, hops, holes, seed, silhouettes (0, 1), rate (Hz), phase (s),
/// jitter (s), dropped, repeat (shares), jump (s), frames, loop, tilt (degrees between the middle
/// ray and the vertical, 0-90), view (degrees that the camera stands round the scene's vertical),
/// width (pixels; the height follows), error (of the pose that it reports, m, with 1/6 degree for
/// each millimetre; after `seed`). Cameras on one clock see one world at one time. `clock` outlives
/// the camera; null: frames come as fast as they are requested, from the scene's time 0 on.
/// @throws Error when a name or a value makes no sense.
[[nodiscard]] std::unique_ptr<SimulatedCamera> open_simulated(const std::string& specification,
                                                              const Clock* clock);

/// Changes a set-up by "KEY=VALUE" (open_simulated() lists which there are).
/// @throws Error when the key is unknown or the value makes no sense.
void set_simulated(SimulatedSetup& setup, const std::string& assignment);

}  // namespace palpate
