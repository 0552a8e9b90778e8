#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpate::sensor {

/// A folder of its own, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "palpate-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp: " + name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

/// A depth image of which all samples are `value`, as PGM.
inline std::string pgm(std::uint16_t value, int width = 4, int height = 3) {
  std::string bytes = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 65535\n";
  for (int i = 0; i < width * height; ++i) {
    bytes += static_cast<char>(value >> 8U);
    bytes += static_cast<char>(value & 0xffU);
  }
  return bytes;
}

}  // namespace palpate::sensor
