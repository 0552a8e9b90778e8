#include "apps/palpate/options/depth_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "apps/palpate/cli/arguments.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/read_depth.hpp"

namespace palpate::app {

namespace {

namespace fs = std::filesystem;

std::string lower(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

bool begins_like_an_image(const std::string& path) {
  std::array<char, 4> bytes{};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view text(bytes.data(), bytes.size());
  return text == "\x89PNG" || (text.starts_with("P5") && std::isspace(bytes[2]) != 0);
}

}  // namespace

bool is_depth_image(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::string name = lower(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name.ends_with(".png") || name.ends_with(".pgm") || begins_like_an_image(path);
}

bool may_be_organised(const std::string& path) {
  std::error_code ignored;
  if (path.starts_with(kSynthetic)) return false;
  if (!fs::is_regular_file(path, ignored) || lower(path).ends_with(".pcd.gz")) return true;
  std::array<char, 2048> bytes{};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), bytes.size());
  const std::size_t height = head.find("\nHEIGHT ");
  return height < head.find("\nDATA ") && !head.substr(height).starts_with("\nHEIGHT 1\n");
}

DepthFrame load_depth_image(const std::string& path, const ReadingOptions& options) {
  if (options.intrinsics.empty()) {
    throw Error(fmt::format(
        "{} is a depth image, and the camera is not known; give its intrinsics in pixels "
        "(--intrinsics fx,fy,cx,cy; a sequence.json or camera file beside the image may hold them) "
        "and the metres of one depth step (--depth-unit)",
        path));
  }
  ReadDepthOptions read;
  read.camera.pinhole = parse_intrinsics(options.intrinsics);
  read.depth_unit = options.depth_unit * options.scale;
  return read_depth_frame(path, read);
}

}  // namespace palpate::app
