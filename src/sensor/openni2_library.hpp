#pragma once

#include <OniCAPI.h>
#include <OniCTypes.h>

#include <string>
#include <vector>

#include "base/shared_library.hpp"

namespace palpate::sensor {

/// OpenNI2's C interface, found at run time: a program that opens none of its cameras needs neither
/// the library nor the threads that it starts.
class OpenNi2Library {
 public:
  /// Loads and starts it. @throws Error that says what is missing.
  OpenNi2Library();
  ~OpenNi2Library();
  OpenNi2Library(const OpenNi2Library&) = delete;
  OpenNi2Library& operator=(const OpenNi2Library&) = delete;

  /// The library's text for its last error, on one line.
  [[nodiscard]] std::string last_words() const;

  decltype(&::oniGetDeviceList) get_device_list = nullptr;
  decltype(&::oniReleaseDeviceList) release_device_list = nullptr;
  decltype(&::oniDeviceOpen) open = nullptr;
  decltype(&::oniDeviceClose) close = nullptr;
  decltype(&::oniDeviceGetSensorInfo) get_sensor_info = nullptr;
  decltype(&::oniDeviceSetProperty) set_device_property = nullptr;
  decltype(&::oniDeviceIsPropertySupported) has_device_property = nullptr;
  decltype(&::oniDeviceCreateStream) create_stream = nullptr;
  decltype(&::oniStreamDestroy) destroy_stream = nullptr;
  decltype(&::oniStreamStart) start = nullptr;
  decltype(&::oniStreamStop) stop = nullptr;
  decltype(&::oniStreamGetProperty) get_property = nullptr;
  decltype(&::oniStreamSetProperty) set_property = nullptr;
  decltype(&::oniWaitForAnyStream) wait = nullptr;
  decltype(&::oniStreamReadFrame) read_frame = nullptr;
  decltype(&::oniFrameRelease) release_frame = nullptr;

 private:
  void find_all();

  SharedLibrary library_;
  decltype(&::oniInitialize) initialize_ = nullptr;
  decltype(&::oniShutdown) shutdown_ = nullptr;
  decltype(&::oniGetExtendedError) get_extended_error_ = nullptr;
};

/// Does it hold all depths that it says, in a format that is known?
[[nodiscard]] bool is_whole(const OniFrame& image);

/// Depths (m, row by row, reusing memory) of a frame that is whole; `mirrored`: left is right.
void copy_depth(const OniFrame& image, bool mirrored, std::vector<float>& depth);

}  // namespace palpate::sensor
