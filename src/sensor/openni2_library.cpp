#include "sensor/openni2_library.hpp"

#include <OniVersion.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>

#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

template <class Function>
bool find(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  return function != nullptr;
}

}  // namespace

OpenNi2Library::OpenNi2Library() {
  // Never unloaded: its drivers leave threads behind.
  void* library = ::dlopen("libOpenNI2.so.0", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) library = ::dlopen("libOpenNI2.so", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr || !find_all(library)) {
    throw Error("openni2: the library libOpenNI2.so.0 cannot be loaded. Install libopenni2-0.");
  }
  if (initialize_(ONI_API_VERSION) == ONI_STATUS_OK) return;
  throw Error(
      fmt::format("openni2: the library does not start ({}). Install libopenni2-0 again; its "
                  "drivers lie in OpenNI2/Drivers beside it.",
                  last_words()));
}

OpenNi2Library::~OpenNi2Library() {
  shutdown_();
}

std::string OpenNi2Library::last_words() const {
  std::string words = get_extended_error_();
  std::ranges::replace_if(
      words, [](char c) { return c < ' '; }, ' ');
  const std::size_t begin = words.find_first_not_of(' ');
  if (begin == std::string::npos) return "no reason given";
  return words.substr(begin, words.find_last_not_of(' ') - begin + 1);
}

bool OpenNi2Library::find_all(void* library) {
  return find(library, "oniInitialize", initialize_) && find(library, "oniShutdown", shutdown_) &&
         find(library, "oniGetExtendedError", get_extended_error_) &&
         find(library, "oniGetDeviceList", get_device_list) &&
         find(library, "oniReleaseDeviceList", release_device_list) &&
         find(library, "oniDeviceOpen", open) && find(library, "oniDeviceClose", close) &&
         find(library, "oniDeviceGetSensorInfo", get_sensor_info) &&
         find(library, "oniDeviceSetProperty", set_device_property) &&
         find(library, "oniDeviceIsPropertySupported", has_device_property) &&
         find(library, "oniDeviceCreateStream", create_stream) &&
         find(library, "oniStreamDestroy", destroy_stream) &&
         find(library, "oniStreamStart", start) && find(library, "oniStreamStop", stop) &&
         find(library, "oniStreamGetProperty", get_property) &&
         find(library, "oniStreamSetProperty", set_property) &&
         find(library, "oniWaitForAnyStream", wait) &&
         find(library, "oniStreamReadFrame", read_frame) &&
         find(library, "oniFrameRelease", release_frame);
}

}  // namespace palpate::sensor
