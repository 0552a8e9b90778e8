#pragma once

#include <OniCAPI.h>
#include <OniCTypes.h>

#include <string>
#include <vector>

#include "base/shared_library.hpp"

namespace palpate::sensor {

/// The part of OpenNI2's C interface that is used here, found at run time: a program that opens
/// none of its cameras needs neither the library nor the threads that it starts.
struct OpenNi2Functions {
  SharedLibrary library;
  decltype(&::oniInitialize) initialize = library["oniInitialize"];
  decltype(&::oniShutdown) shutdown = library["oniShutdown"];
  decltype(&::oniGetExtendedError) get_extended_error = library["oniGetExtendedError"];
  decltype(&::oniGetDeviceList) get_device_list = library["oniGetDeviceList"];
  decltype(&::oniReleaseDeviceList) release_device_list = library["oniReleaseDeviceList"];
  decltype(&::oniDeviceOpen) open = library["oniDeviceOpen"];
  decltype(&::oniDeviceClose) close = library["oniDeviceClose"];
  decltype(&::oniDeviceGetSensorInfo) get_sensor_info = library["oniDeviceGetSensorInfo"];
  decltype(&::oniDeviceSetProperty) set_device_property = library["oniDeviceSetProperty"];
  decltype(&::oniDeviceIsPropertySupported) has_device_property =
      library["oniDeviceIsPropertySupported"];
  decltype(&::oniDeviceCreateStream) create_stream = library["oniDeviceCreateStream"];
  decltype(&::oniStreamDestroy) destroy_stream = library["oniStreamDestroy"];
  decltype(&::oniStreamStart) start = library["oniStreamStart"];
  decltype(&::oniStreamStop) stop = library["oniStreamStop"];
  decltype(&::oniStreamGetProperty) get_property = library["oniStreamGetProperty"];
  decltype(&::oniStreamSetProperty) set_property = library["oniStreamSetProperty"];
  decltype(&::oniWaitForAnyStream) wait = library["oniWaitForAnyStream"];
  decltype(&::oniStreamReadFrame) read_frame = library["oniStreamReadFrame"];
  decltype(&::oniFrameRelease) release_frame = library["oniFrameRelease"];
};

/// OpenNI2, running.
class OpenNi2Library : public OpenNi2Functions {
 public:
  /// Loads and starts it. @throws Error that states what is missing.
  OpenNi2Library();
  ~OpenNi2Library();
  OpenNi2Library(const OpenNi2Library&) = delete;
  OpenNi2Library& operator=(const OpenNi2Library&) = delete;

  /// The library's text for its last error, on one line.
  [[nodiscard]] std::string last_words() const;
};

/// Does it contain all depths of its size, in a supported format?
[[nodiscard]] bool is_whole(const OniFrame& image);

/// Depths (m, row by row, reusing memory) of a frame that is whole; `mirrored`: left is right.
void copy_depth(const OniFrame& image, bool mirrored, std::vector<float>& depth);

}  // namespace palpate::sensor
