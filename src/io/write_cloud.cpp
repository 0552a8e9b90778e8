#include "palpate/io/write_cloud.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "io/input.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

CloudFormat format_of(const std::filesystem::path& path) {
  const std::string ending = io::extension(path.string());
  if (ending == ".ply") return CloudFormat::ply;
  if (ending == ".pcd") return CloudFormat::pcd;
  throw Error(fmt::format("{}: clouds are written as .ply or .pcd. Choose one of these extensions.",
                          path.string()));
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  throw Error(
      fmt::format("{}: cannot be written ({} bytes). Check that the folder exists and may be "
                  "written, and that the disk has room.",
                  path.string(), bytes.size()));
}

}  // namespace

void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options) {
  const std::string bytes = encode_cloud(cloud, format_of(path), options);
  std::filesystem::path part = path;
  part += ".part";
  write_bytes(part, bytes);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw Error(
      fmt::format("{}: cannot be replaced ({}). Check that it is no folder and may be written.",
                  path.string(), error.message()));
}

}  // namespace palpate
