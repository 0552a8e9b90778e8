#pragma once

#include <string>

#include "palpate/depth/depth_frame.hpp"

namespace palpate {

/// What came of asking a camera for a frame.
enum class CameraStatus {
  frame,    ///< a new frame
  waiting,  ///< none within the time that was given
  damaged,  ///< one that cannot be used (cut, garbage): reason() says why; the next may be good
  unposed,  ///< one of a recording with poses that has none; reason() names it, the next may have
            ///< one
  ended,    ///< a recording has come to its end
  failed,   ///< unplugged, out of order: reason() says why; asking again may help
};

struct CameraInfo {
  std::string name;   ///< for messages, such as "simulated:table"
  double rate = 30;   ///< frames a second that it is made for, Hz
  bool paces = true;  ///< read() waits for frames as they happen; false: as fast as it is asked
  /// A frame may be the one before bit for bit though all is well: there is no noise in it, or one
  /// image is all there is. From other cameras such a frame says that the picture is frozen.
  bool repeats = false;
};

/// A source of depth frames. One thread uses it. Construction opens it and throws Error.
class DepthCamera {
 public:
  virtual ~DepthCamera() = default;

  [[nodiscard]] virtual const CameraInfo& info() const noexcept = 0;

  /// What can begin does so again with its first frame, which is taken at `start`, s on the clock
  /// of the stamps: recordings, and simulations that wait for no clock. Cameras that see
  /// what happens now go on. Streams call it, so that what was read before takes nothing from them.
  /// @throws Error when a recording cannot be opened again.
  virtual void begin(double /*start*/) {}

  /// Fills `frame` with the next image, reusing its memory, waiting for it at most `timeout` s.
  [[nodiscard]] virtual CameraStatus read(DepthFrame& frame, double timeout) = 0;

  /// Why the last read() failed or what damaged its frame, and what to do; empty otherwise.
  [[nodiscard]] virtual std::string reason() const = 0;

 protected:
  DepthCamera() = default;
  DepthCamera(const DepthCamera&) = default;
  DepthCamera& operator=(const DepthCamera&) = default;
};

}  // namespace palpate
