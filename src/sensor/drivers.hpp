#pragma once

#include <memory>
#include <string>

#include "palpate/sensor/depth_camera.hpp"

// The optional drivers. The build takes DRIVER_camera.cpp where its library is there, and what it
// makes of absent_camera.cpp.in where it is not.
namespace palpate::sensor {

[[nodiscard]] DriverInfo openni2_driver();
/// `device`: empty, a URI, or the path of an .oni file.
[[nodiscard]] std::unique_ptr<DepthCamera> open_openni2(const std::string& device,
                                                        const CameraOptions& options);

[[nodiscard]] DriverInfo freenect_driver();
/// `device`: empty or a number.
[[nodiscard]] std::unique_ptr<DepthCamera> open_freenect(const std::string& device,
                                                         const CameraOptions& options);

}  // namespace palpate::sensor
