// The drivers of cameras, and what those of real devices share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "palpate/base/clock.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::sensor {

// The drivers. Of the optional ones the build takes DRIVER_camera.cpp where its library is there,
// and what it makes of absent_camera.cpp.in where it is not.
[[nodiscard]] DriverInfo openni2_driver();
/// `device`: empty, a URI, or the path of an .oni file.
[[nodiscard]] std::unique_ptr<DepthCamera> open_openni2(const std::string& device,
                                                        const CameraOptions& options);

[[nodiscard]] DriverInfo freenect_driver();
/// `device`: empty or a number.
[[nodiscard]] std::unique_ptr<DepthCamera> open_freenect(const std::string& device,
                                                         const CameraOptions& options);

[[nodiscard]] DriverInfo ros_driver();
/// `name`: "TOPIC[,frame=FRAME][,unit=METRES]", a topic of depth images (Image of 16UC1 or 32FC1
/// with the CameraInfo beside it, or CompressedImage) or of PointCloud2, whose publisher may appear
/// later. With a frame, /tf and /tf_static report where the sensor is in it; a unit is the metres a
/// step of depths or coordinates, unless the type defines them. Stamps of programs on this
/// machine's clock are brought to the stream's; others (10 s off) are replaced by the time of
/// arrival. The environment sets the domain (dds::environment_options()).
[[nodiscard]] std::unique_ptr<DepthCamera> open_ros(const std::string& name,
                                                    const CameraOptions& options);

[[nodiscard]] DriverInfo remote_driver();
/// `path`: of the socket that programs send frames to (docs/remote_camera.md); empty:
/// palpate-camera in $XDG_RUNTIME_DIR. Serves one program at a time, each with the same camera as
/// the first, and gives the newest of the frames that came.
/// @throws Error when the socket cannot be had.
[[nodiscard]] std::unique_ptr<DepthCamera> open_remote(const std::string& path,
                                                       const CameraOptions& options);

[[nodiscard]] DriverInfo bag_driver();
/// `name`: "FILE[:TOPIC][,frame=FRAME][,unit=METRES]", depth images or clouds (as for open_ros())
/// in an MCAP bag of ROS 2's messages, which is read as it is played; without a topic the only one
/// that fits. With a frame, the bag's transforms report where the sensor is in it, those recorded
/// up to 0.1 s after the image included. Played as PlayedCamera does. What is damaged of the file
/// is left out and reported as damaged frames.
/// @throws Error when it is no bag, or no topic or camera in it can be used; lists what can.
[[nodiscard]] std::unique_ptr<DepthCamera> open_bag(const std::string& name,
                                                    const CameraOptions& options);

/// The depth camera of a Kinect v1 (and its PrimeSense relatives) by its maker's nominal values;
/// single devices differ from them by about a percent.
[[nodiscard]] Pinhole kinect_pinhole(int width, int height);

/// Metres of a raw 11-bit value, the disparity in eighths of a pixel against a reference plane at
/// 1.2 m. 0 for 2047 and above ("nothing measured") and for what is beyond 15 m.
[[nodiscard]] float kinect_metres(std::uint16_t raw);

/// Brings the times of a device's own clock to the host's. A frame arrives no earlier than it was
/// taken, so the smallest difference between arrival and the device's time is the best guess of how
/// the clocks differ; it may grow slowly, as clocks drift. What every frame takes at least to
/// arrive is unknown, and stays in the stamps. A device's time that goes back or jumps by a
/// second starts again.
class HostStamps {
 public:
  /// The host's time of a frame taken at `device` (s, the device's clock) that came at `arrival`
  /// (s, the host's clock). Never after `arrival`.
  [[nodiscard]] double host(double device, double arrival);

 private:
  std::optional<double> difference_;  // host - device, s
  double arrival_ = 0;                // of the frame before
  double device_ = 0;                 // of the same frame
};

/// A device that is open and delivers. The destructor closes it.
class Connection {
 public:
  virtual ~Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Fills camera, depth and colours of `frame`, and `device_time` (s, the device's clock), waiting
  /// `timeout` s at most. Never `failed`: it throws then.
  /// @throws Error when the device is lost.
  [[nodiscard]] virtual DepthCamera::Status fetch(DepthFrame& frame, double& device_time,
                                                  double timeout) = 0;

  /// Describes what was wrong with the frame that fetch() called `damaged`.
  [[nodiscard]] virtual std::string damage() const { return {}; }

 protected:
  Connection() = default;
};

/// @throws Error that states why the device cannot be opened.
using Connect = std::function<std::unique_ptr<Connection>()>;

/// Treatment of a device that is lost.
enum class Lost {
  opened_again,  ///< when the next frame is requested; also when it is silent for long
  ended,         ///< a recording: opened again, it plays from its beginning
};

/// Stamps the frames of a real device by the host's clock, and opens a lost device again. If the
/// device does not pace itself, stamps are its own times, from 0 on, and continue when a recording
/// starts again.
class LiveCamera final : public DepthCamera {
 public:
  /// Opens the device. `silence` names what a device that is silent for long may lack. Without a
  /// clock, the host's is taken.
  LiveCamera(CameraInfo info, Connect connect, std::string silence, const Clock* clock,
             Lost lost = Lost::opened_again);

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override;
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;
  [[nodiscard]] std::string reason() const override { return reason_; }

 private:
  void connect();
  [[nodiscard]] DepthCamera::Status fetch(DepthFrame& frame, double timeout);
  [[nodiscard]] DepthCamera::Status silent(double now);
  [[nodiscard]] double stamp_of(double device_time, double now);

  CameraInfo info_;
  Connect connect_;
  std::string silence_;
  SteadyClock host_;
  const Clock* clock_;  // null: host_
  Lost lost_;
  std::unique_ptr<Connection> connection_;
  HostStamps stamps_;
  double stamp_ = 0;  // of the last frame of a device that does not pace itself
  std::optional<double> device_time_ = {};  // of that frame
  double received_ = 0;                     // when the last frame came, s
  std::string reason_;
};

}  // namespace palpate::sensor
