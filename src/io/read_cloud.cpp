#include <new>
#include <utility>

#include "io/cloud_builder.hpp"
#include "io/depth_image.hpp"
#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/cloud_file.hpp"

namespace palpate {
namespace {

using namespace io;

CloudFile read_kind(const Input& input, FileKind kind) {
  switch (kind) {
    case FileKind::ply:
      return read_ply(input);
    case FileKind::pcd:
      return read_pcd(input);
    case FileKind::las:
      return read_las(input);
    case FileKind::obj:
      return read_obj(input);
    case FileKind::text:
      return read_xyz(input);
    case FileKind::png:
      return cloud_of(input, read_png(input));
    case FileKind::pgm:
      return cloud_of(input, read_pgm(input));
    case FileKind::gzip:
      break;
  }
  fail(input, "compressed with gzip twice", "Unpack it once with gunzip");
}

// "cloud.ply.gz" holds "cloud.ply".
std::string name_inside(const std::string& name) {
  return extension(name) == ".gz" ? name.substr(0, name.size() - 3) : name;
}

CloudFile read_packed(const Input& input) {
  const Bytes unpacked = gunzip(input);
  const Input inside{unpacked.span(), name_inside(input.name), input.options};
  CloudFile file = read_kind(inside, kind_of(inside));
  file.format += ", gzip";
  return file;
}

}  // namespace

CloudFile read_cloud_bytes(std::span<const std::byte> bytes, const std::string& name,
                           const ReadOptions& options) {
  const Input input{bytes, name, options};
  check_options(input);
  try {
    const FileKind kind = kind_of(input);
    CloudFile file = kind == FileKind::gzip ? read_packed(input) : read_kind(input, kind);
    if (options.progress) options.progress(1.0);
    return file;
  } catch (const std::bad_alloc&) {
    fail(input, "not enough memory for its points",
         "Downsample the cloud or split it into tiles first");
  }
}

CloudFile read_cloud_file(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string name = path == "-" ? "standard input" : path.string();
  try {
    const Bytes bytes = read_bytes(path);
    return read_cloud_bytes(bytes.span(), name, options);
  } catch (const std::bad_alloc&) {
    throw Error(
        name +
        ": not enough memory to read it. Downsample the cloud or split it into tiles first.");
  }
}

PointCloud read_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  return read_cloud_file(path, options).cloud;
}

}  // namespace palpate
