// Declares what every depth camera offers, and how cameras are listed and opened.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate {

struct CameraInfo {
  std::string name;   ///< for messages, such as "simulated:table"
  double rate = 30;   ///< frames a second that it is made for, Hz
  bool paces = true;  ///< read() waits for frames as they happen; false: as fast as it is read
  /// A frame may be the one before bit for bit though all is well: there is no noise in it, or one
  /// image is all there is. From other cameras such a frame means that the picture is frozen.
  bool repeats = false;
  /// Another program sends its frames and may come at any time: until then it waits.
  bool awaits_sender = false;
  /// Assumptions made where the camera gives no value, in words; empty: none.
  std::string assumed = {};
};

/// A source of depth frames. One thread uses it. Construction opens it and throws Error.
class DepthCamera {
 public:
  /// Result of read().
  enum class Status {
    frame,    ///< a new frame
    waiting,  ///< none within the time that was given
    damaged,  ///< one that cannot be used (cut, garbage): reason() states why; the next may be good
    unposed,  ///< one of a recording with poses that has none; reason() names it, the next may have
              ///< one
    ended,    ///< a recording has come to its end
    failed,   ///< unplugged, out of order: reason() states why; another read may help
  };

  virtual ~DepthCamera() = default;

  [[nodiscard]] virtual const CameraInfo& info() const noexcept = 0;

  /// Rewinds recordings, and simulations that wait for no clock: their first frame is then taken at
  /// `start`, s on the clock of the stamps. No effect on live cameras. Streams call it, so that
  /// frames read before are not lost to them.
  /// @throws Error when a recording cannot be opened again.
  virtual void begin(double /*start*/) {}

  /// Fills `frame` with the next image, reusing its memory, waiting for it at most `timeout` s.
  [[nodiscard]] virtual Status read(DepthFrame& frame, double timeout) = 0;

  /// Why the last read() failed, what damaged its frame or, if that is known, what it waits for,
  /// and what to do; empty otherwise.
  [[nodiscard]] virtual std::string reason() const = 0;

 protected:
  DepthCamera() = default;
  DepthCamera(const DepthCamera&) = default;
  DepthCamera& operator=(const DepthCamera&) = default;
};

struct CameraOptions {
  /// Clock of the stamps; outlives the camera. Recordings and simulated cameras also wait for
  /// it; null: they are as fast as they are read, and real cameras stamp by the host's clock.
  const Clock* clock = nullptr;
  bool loop = false;  ///< recordings begin again at the end
};

/// Opens a camera by name: "simulated[:SCENE[,KEY=VALUE]...]" (docs/simulated_cameras.md),
/// "sequence:DIR" (docs/sequences.md), "bag:FILE[:TOPIC][,frame=FRAME][,unit=METRES]"
/// (docs/bags.md), "openni2[:URI]" (PrimeSense, Xtion; without URI the first that is there),
/// "openni2:FILE.oni" or just "FILE.oni", "freenect[:NUMBER]" (Kinect v1; the first is 0),
/// "ros:TOPIC[,frame=FRAME][,unit=METRES]" (docs/ros2.md), "remote[:PATH]" (docs/remote_camera.md).
/// Set-up: one thread at a time.
/// @throws Error when the name is none of these, when the build lacks the driver, when there is no
///   such camera, it is in use or may not be used; its message states what to do.
[[nodiscard]] std::unique_ptr<DepthCamera> open_camera(const std::string& name,
                                                       const CameraOptions& options = {});

/// Every driver, with what it finds. Set-up: one thread at a time; may take a second.
[[nodiscard]] std::vector<DriverInfo> list_cameras();

}  // namespace palpate
