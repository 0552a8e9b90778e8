// Reads clouds in a core by itself: the points of PLY files.
#include "io/file_bytes.hpp"
#include "io/input.hpp"
#include "io/ply_points.hpp"
#include "palpate/io/files.hpp"

namespace palpate {

PointCloud read_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  const io::Bytes bytes = io::read_bytes(path);
  return io::read_ply_points({bytes.span(), path.string(), options}).cloud;
}

}  // namespace palpate
