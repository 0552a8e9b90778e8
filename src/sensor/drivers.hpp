#pragma once

#include <memory>
#include <string>

#include "palpate/sensor/open_camera.hpp"

// The optional drivers. Each has two sources, of which the build takes one: DRIVER_camera.cpp where
// its library is there, DRIVER_absent.cpp where it is not.
namespace palpate::sensor {

[[nodiscard]] DriverInfo openni2_driver();
/// `device`: empty, a URI, or the path of an .oni file.
[[nodiscard]] std::unique_ptr<DepthCamera> open_openni2(const std::string& device,
                                                        const CameraOptions& options);

[[nodiscard]] DriverInfo freenect_driver();
/// `device`: empty or a number.
[[nodiscard]] std::unique_ptr<DepthCamera> open_freenect(const std::string& device,
                                                         const CameraOptions& options);

[[nodiscard]] DriverInfo ros_driver();
/// `name`: "TOPIC[,frame=FRAME]", a topic of depth images (Image of 16UC1 or 32FC1 with the
/// CameraInfo beside it, or CompressedImage) or of PointCloud2, whose publisher may appear later.
/// With a frame, /tf and /tf_static say where the sensor is in it. Stamps of programs on this
/// machine's clock are brought to the stream's; others (10 s off) are replaced by the time of
/// arrival. The environment says in which domain (dds::options_from()).
[[nodiscard]] std::unique_ptr<DepthCamera> open_ros(const std::string& name,
                                                    const CameraOptions& options);

}  // namespace palpate::sensor
