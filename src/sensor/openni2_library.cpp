// Loads OpenNI2 at run time.
#include "sensor/openni2_library.hpp"

#include <OniVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {
namespace {

SharedLibrary load_openni2() {
  try {
    // Its drivers leave threads behind.
    return {
        {"libOpenNI2.so.0", "libOpenNI2.so"}, "Install libopenni2-0", SharedLibrary::Unload::never};
  } catch (const Error& error) {
    throw Error(fmt::format("openni2: {}", error.what()));
  }
}

}  // namespace

OpenNi2Library::OpenNi2Library() : OpenNi2Functions{load_openni2()} {
  if (initialize(ONI_API_VERSION) == ONI_STATUS_OK) return;
  throw Error(
      fmt::format("openni2: the library does not start ({}). Reinstall libopenni2-0; its drivers "
                  "are in OpenNI2/Drivers next to it.",
                  last_words()));
}

OpenNi2Library::~OpenNi2Library() {
  shutdown();
}

std::string OpenNi2Library::last_words() const {
  std::string words = get_extended_error();
  std::ranges::replace_if(
      words, [](char c) { return c < ' '; }, ' ');
  const std::size_t begin = words.find_first_not_of(' ');
  if (begin == std::string::npos) return "no reason given";
  return words.substr(begin, words.find_last_not_of(' ') - begin + 1);
}

bool is_whole(const OniFrame& image) {
  const auto format = image.videoMode.pixelFormat;
  if (format != ONI_PIXEL_FORMAT_DEPTH_100_UM && format != ONI_PIXEL_FORMAT_DEPTH_1_MM) {
    return false;
  }
  // These may come from a file, and their products be beyond an int.
  const std::int64_t row = std::int64_t{sizeof(OniDepthPixel)} * image.width;
  const std::int64_t stride = image.stride;
  return image.data != nullptr && image.width > 0 && image.height > 0 && stride >= row &&
         image.dataSize >= stride * (image.height - 1) + row;
}

void copy_depth(const OniFrame& image, bool mirrored, std::vector<float>& depth) {
  const bool fine = image.videoMode.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM;
  const double unit = fine ? 1e-4 : 1e-3;
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  const auto stride = static_cast<std::size_t>(image.stride);
  depth.resize(width * height);
  const auto* bytes = static_cast<const std::byte*>(image.data);
  for (std::size_t v = 0; v < height; ++v) {
    const auto* row = reinterpret_cast<const OniDepthPixel*>(bytes + v * stride);
    const std::span out(depth.data() + v * width, width);
    to_metres({row, width}, unit, out);
    if (mirrored) std::ranges::reverse(out);
  }
}

}  // namespace palpate::sensor
