// Reads cloud and depth image files of any supported kind, gzipped or not.
#include "palpate/io/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "base/progress.hpp"
#include "geometry/inner_box.hpp"
#include "io/cloud_builder.hpp"
#include "io/depth_image.hpp"
#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/mesh/triangles.hpp"
#include "io/potree/potree.hpp"
#include "io/splats/splats.hpp"
#include "io/units/file_unit.hpp"
#include "io/whole_store.hpp"
#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"

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
    case FileKind::e57:
      return read_e57(input);
    case FileKind::obj:
      return read_obj(input);
    case FileKind::stl:
      return read_stl(input);
    case FileKind::gltf:
      return read_gltf(input);
    case FileKind::xyz:
      return read_xyz(input);
    case FileKind::ptx:
      return read_ptx(input);
    case FileKind::npy:
      return read_array(input);
    case FileKind::png:
      return cloud_of(input, read_png(input));
    case FileKind::pgm:
      return cloud_of(input, read_pgm(input));
    case FileKind::spz:
      return shell_file(input, read_spz);
    case FileKind::splat:
      return shell_file(input, read_dot_splat);
    case FileKind::gz:
      break;
  }
  fail(input, "compressed with gzip twice", "Unpack it once with gunzip");
}

// "cloud.ply.gz" holds "cloud.ply".
std::string name_inside(const std::string& name) {
  return extension(name) == ".gz" ? name.substr(0, name.size() - 3) : name;
}

// Unpacks a file, named `inside`. An unknown kind is refused by its first bytes, before the rest is
// unpacked.
Bytes unpack(const Input& input, const std::string& inside) {
  constexpr std::size_t kStart = std::size_t{1} << 16U;
  const Bytes start = gunzip(input, kStart);
  (void)kind_of({start.span(), inside, input.options});
  return gunzip(input);
}

// Makes the cloud as long as the caller states.
void fit_length(const Input& input, CloudFile& file) {
  if (!input.options.length || file.cloud.empty()) return;
  constexpr std::size_t kOutermost = 200;  // one point in so many, at either end (judgement)
  const PointCloud& cloud = file.cloud;
  const Box inner = detail::inner_box(cloud.positions, cloud.size() / kOutermost);
  const double length = inner.size().maxCoeff();
  file.unit.source = FileUnit::Source::given;
  if (!(length > 0)) {
    fail(input, "all points are at one place, so no length fits",
         "Give no length, or another file");
  }
  rescale(file, *input.options.length / length);
}

// Leaves out a byte order mark, but where the bytes are numbers.
Input without_mark(const Input& input) {
  Input result = input;
  const bool marked = input.text().starts_with(kByteOrderMark);
  const std::string ending = extension(input.name);
  if (marked && ending != ".splat" && ending != ".bin" && !is_stl(input)) {
    result.bytes = input.bytes.subspan(kByteOrderMark.size());
  }
  return result;
}

CloudFile read_packed(const Input& input) {
  const Bytes unpacked = unpack(input, name_inside(input.name));
  const Input inside = without_mark(
      {unpacked.span(), name_inside(input.name), input.options, input.folder, input.faces});
  CloudFile file = read_kind(inside, kind_of(inside));
  file.format += ", gzip";
  return file;
}

CloudFile read_input(const Input& given) {
  const Input input = without_mark(given);
  check_options(input);
  try {
    const FileKind kind = kind_of(input);
    CloudFile file = kind == FileKind::gz ? read_packed(input) : read_kind(input, kind);
    fit_length(input, file);
    file.format += words_of(file.unit);  // none where a length is given
    detail::tell(input.options.progress, 1);
    return file;
  } catch (const std::bad_alloc&) {
    fail(input, "not enough memory for its points",
         "Downsample the cloud or split it into tiles first");
  }
}

CloudFile read_potree(const Input& input) {
  check_options(input);
  CloudFile file = read_whole(*open_potree(input.name, input.options), input);
  fit_length(input, file);
  detail::tell(input.options.progress, 1);
  return file;
}

}  // namespace

CloudFile read_cloud_bytes(std::span<const std::byte> bytes, const std::string& name,
                           const ReadOptions& options) {
  return read_input({bytes, name, options});
}

CloudFile read_cloud_file(const std::filesystem::path& path, const ReadOptions& options) {
  const bool piped = path == "-";
  try {
    std::error_code unknown;
    if (is_potree(path) || std::filesystem::is_directory(path, unknown)) {
      return read_potree({{}, path.string(), options});
    }
    const bool is_file = std::filesystem::exists(path, unknown);
    const Bytes bytes = read_bytes(is_file ? path.string() : split_scan(path.string()).file);
    if (piped) return read_cloud_bytes(bytes.span(), "standard input", options);
    return read_input({bytes.span(), path.string(), options, path.parent_path() / "."});
  } catch (const std::bad_alloc&) {
    throw Error(
        (piped ? "standard input" : path.string()) +
        ": not enough memory to read it. Downsample the cloud or split it into tiles first.");
  }
}

PointCloud read_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  return read_cloud_file(path, options).cloud;
}

TriangleMesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  const bool piped = path == "-";
  try {
    Mesh faces;
    const Bytes bytes = read_bytes(path);
    Input input{bytes.span(), piped ? "standard input" : path.string(), options,
                path.parent_path() / ".", &faces};
    CloudFile file = read_input(input);
    input.unit = file.unit;
    TriangleMesh mesh = triangles_of(input, faces, std::move(file.format));
    mesh.unit = file.unit;
    mesh.facts = file.mesh.value_or(MeshFacts());
    return mesh;
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": not enough memory to read it. Simplify the mesh first.");
  }
}

std::vector<std::filesystem::path> scans_of(const std::filesystem::path& path) {
  constexpr std::string_view kE57 = "ASTM-E57";
  std::error_code none;
  if (extension(path.string()) != ".e57" || !std::filesystem::is_regular_file(path, none)) {
    return {path};
  }
  try {
    const Bytes bytes = read_bytes(path);
    const ReadOptions options;
    const Input input{bytes.span(), path.string(), options};
    if (!input.text().starts_with(kE57)) return {path};
    std::vector<std::filesystem::path> scans;
    for (const std::size_t number : e57_scans_with_points(input)) {
      scans.emplace_back(fmt::format("{}#{}", path.string(), number));
    }
    return scans.size() > 1 ? scans : std::vector{path};
  } catch (const std::bad_alloc&) {
    throw Error(path.string() +
                ": not enough memory to read which scans it holds. Close other programs, or split "
                "it into files of one scan first.");
  }
}

namespace {

DepthImage read_image_of(const Input& input, FileKind kind) {
  if (kind == FileKind::png) return read_png(input);
  if (kind == FileKind::pgm) return read_pgm(input);
  fail(input, "not a depth image", "Give a 16-bit grey PNG or PGM");
}

DepthImage read_image(const Input& input) {
  const FileKind kind = kind_of(input);
  if (kind != FileKind::gz) return read_image_of(input, kind);
  const Bytes unpacked = unpack(input, input.name);
  const Input inside{unpacked.span(), input.name, input.options};
  return read_image_of(inside, kind_of(inside));
}

void check_size(const Input& input, const DepthImage& image, const CameraModel& camera) {
  const auto fits = [](int wanted, std::size_t found) {
    return wanted == 0 || static_cast<std::size_t>(wanted) == found;
  };
  if (fits(camera.width, image.width) && fits(camera.height, image.height)) return;
  fail(input,
       fmt::format("an image of {} x {} pixels, but the camera has {} x {}", image.width,
                   image.height, camera.width, camera.height),
       "Give the camera's own images, or correct its width and height");
}

void straighten(const Input& input, DepthImage& image, bool swapped) {
  if (swapped) {
    swap_bytes(image);
  } else if (looks_swapped(image)) {
    fail(input, "the two bytes of its samples seem to be swapped",
         "If so, set \"byte_order\": \"little\" in a sequence.json, or write the image again");
  }
}

// Makes marks for "nothing measured" the usual one.
void blank(DepthImage& image, const std::vector<std::uint16_t>& invalid) {
  std::ranges::replace_if(
      image.samples,
      [&](std::uint16_t sample) {
        return !is_depth(image, sample) || std::ranges::find(invalid, sample) != invalid.end();
      },
      std::uint16_t{0});
}

void read_bytes_into(std::span<const std::byte> bytes, const std::string& name,
                     const ReadDepthOptions& options, DepthFrame& frame) {
  ReadOptions as_cloud;
  if (options.camera.pinhole.fx != 0) as_cloud.intrinsics = options.camera.pinhole;
  as_cloud.depth_unit = options.depth_unit;
  const Input input{bytes, name, as_cloud};
  try {
    DepthImage image = read_image(input);
    CameraModel camera = options.camera;
    camera.pinhole = intrinsics_of(input, image);
    const double unit = unit_of(input);
    check_size(input, image, camera);
    straighten(input, image, options.swapped);
    camera.width = static_cast<int>(image.width);
    camera.height = static_cast<int>(image.height);
    blank(image, options.invalid);
    frame.depth.resize(image.samples.size());
    to_metres(image.samples, unit, frame.depth);
    frame.colors.clear();
    frame.camera = camera;
  } catch (const std::bad_alloc&) {
    fail(input, "not enough memory for its pixels", "Close other programs");
  }
}

}  // namespace

DepthFrame read_depth_frame_bytes(std::span<const std::byte> bytes, const std::string& name,
                                  const ReadDepthOptions& options) {
  DepthFrame frame;
  read_bytes_into(bytes, name, options, frame);
  return frame;
}

void read_depth_frame(const std::filesystem::path& path, const ReadDepthOptions& options,
                      DepthFrame& frame) {
  const Bytes bytes = read_bytes(path);
  read_bytes_into(bytes.span(), path == "-" ? "standard input" : path.string(), options, frame);
}

DepthFrame read_depth_frame(const std::filesystem::path& path, const ReadDepthOptions& options) {
  DepthFrame frame;
  read_depth_frame(path, options, frame);
  return frame;
}

}  // namespace palpate
