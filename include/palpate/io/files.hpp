// Declares the readers and writers of cloud and depth image files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/file_unit.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"

namespace palpate {

struct ReadOptions {
  /// m a unit of the file, whose depths it multiplies, too. Unset: what the file states, else
  /// millimetres for a mesh without a unit that may be a part of a machine, else metres.
  std::optional<double> scale{};
  std::optional<double> height_scale{};  ///< m a unit of z, where it is not `scale`
  /// m; chooses the scale so that the longest side of the cloud's box, without the outermost half
  /// percent at either end of each axis, is so long.
  std::optional<double> length{};
  std::optional<Pinhole> intrinsics{};  ///< of a depth image; needed for one
  double depth_unit = 1e-3;             ///< metres a step of a depth image
  double mesh_spacing = 0;              ///< m, of points that faces are sampled into; 0: chosen
  /// Called with 0 ... 1 now and then, on this thread; may throw to give up.
  std::function<void(double)> progress{};
};

/// How the Gaussian splats of a file became points.
struct SplatFacts {
  std::size_t visible = 0;    ///< splats of opacity 0.02 and more
  double spacing = 0;         ///< edge of the cells, each of which gave a point at most, m
  double without_normal = 0;  ///< share of points without a normal of their own, 0 to 1
  std::size_t far = 0;        ///< left out, as they are more than 16 384 cells from the middle
  std::size_t huge = 0;    ///< left out, as they are the largest, and 50 samples a splat are over
  std::size_t pieces = 0;  ///< groups of fewer than 60 cells that were dropped
};

/// What a file's faces became.
struct MeshFacts {
  std::size_t triangles = 0;   ///< that are used; a face of n corners counts as n - 2
  std::size_t dropped = 0;     ///< faces without an area or with a corner that is not finite
  std::size_t duplicates = 0;  ///< faces left out, as another has the same corners
  double spacing = 0;          ///< m, of points sampled from the faces; 0: the vertices are felt
};

/// A cloud and what its file stated about itself.
struct CloudFile {
  PointCloud cloud;
  std::string format;        ///< such as "PLY, binary little endian"
  FileUnit unit{};           ///< that was used
  std::size_t declared = 0;  ///< points or splats of the file; of a depth image its pixels
  std::size_t dropped = 0;   ///< of them not finite, beyond 10^12 m, or marked invalid
  std::optional<SplatFacts> splats{};  ///< of a scene of splats
  std::optional<MeshFacts> mesh{};     ///< of a file with faces
};

/// Reads PLY, PCD, XYZ/TXT/CSV, PTS, PTX, OBJ, STL, glTF, GLB, LAS, LAZ (COPC too), E57, NumPy's
/// .npy, KITTI's .bin, 16-bit depth PNG and PGM; gzip around any of them. The kind is found from
/// the bytes first and from the name second; "-" is standard input. Points that are not finite are
/// dropped and counted; pixels without a depth, and those beyond ten times the image's median
/// depth, too.
///
/// A folder with the metadata.json of a Potree 2.0 store (or that file) is read whole.
///
/// Faces are sampled into points, unless the vertices lie as densely and evenly as those of a scan.
/// Gaussian splats (PLY, compressed PLY, .splat, .spz) become points on the surface that they show,
/// with normals and colours. All scans of an E57 file are joined in the file's frame; "house.e57#2"
/// is the second one alone, with its viewpoint where a scanner stood there.
///
/// The unit of its coordinates is what `options` say, else what the file states (LAS, COPC and
/// Potree by their systems of coordinates; comments, and headers of columns), else what is likely;
/// `unit` of the result says which.
///
/// The cloud's origin stays zero where floats around zero lose at most four bits; otherwise it is
/// a round point near the median of the cloud.
/// @throws Error that names the file, the position in it (byte or line) and a remedy: also for a
///   file that is cut, holds no usable point, or announces more than its bytes can hold.
[[nodiscard]] CloudFile read_cloud_file(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

/// The same for bytes in memory. `name` stands for the file in messages and gives its extension.
/// A glTF file whose data lie in further files is refused.
[[nodiscard]] CloudFile read_cloud_bytes(std::span<const std::byte> bytes, const std::string& name,
                                         const ReadOptions& options = {});

/// The paths of an E57 file's scans that hold points, if it has several: "house.e57#1" and so on.
/// Any other path alone. @throws Error as read_cloud_file() does.
[[nodiscard]] std::vector<std::filesystem::path> scans_of(const std::filesystem::path& path);

/// Opens a COPC file or a folder of Potree 2.0 to be read node by node. `options`: the
/// scale. null: it is no store. @throws Error as read_cloud_file() does.
[[nodiscard]] std::shared_ptr<const PointStore> open_store(const std::filesystem::path& path,
                                                           const ReadOptions& options = {});

/// The cloud alone.
[[nodiscard]] PointCloud read_cloud(const std::filesystem::path& path,
                                    const ReadOptions& options = {});

/// The faces of a file as triangles.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices{};                ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles{};  ///< indices of vertices
  std::string format{};                                   ///< such as "STL, binary"
  MeshFacts facts{};                                      ///< which faces of the file they are
  FileUnit unit{};                                        ///< that was used
};

/// Reads the faces of PLY, OBJ, STL, glTF and GLB, as Tool::mesh() takes them. Left out is what
/// read_cloud_file() leaves out, too: faces without an area, or there twice. `options`: the scale.
/// @throws Error as read_cloud_file() does, when there is no face, and for one of more than three
/// corners that triangles from one of them do not cover.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path,
                                     const ReadOptions& options = {});

struct WriteOptions {
  bool ascii = false;  ///< text instead of binary (little endian); digits enough to lose none
};

/// Writes positions in metres, and normals, colours and intensities where the cloud has them, as
/// PLY or PCD by the path's extension. Coordinates are float where the origin is zero, else double.
/// PCD keeps the viewpoint, PLY cannot store one. What was under `path` is replaced only once
/// the new file is complete.
/// @throws Error for another extension, columns of unequal length, or a path that cannot be
/// written.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options = {});

struct ReadDepthOptions {
  CameraModel camera;        ///< its pinhole is needed; width and height 0: whatever the image has
  double depth_unit = 1e-3;  ///< metres a step of the image
  /// Values that mean "nothing measured", besides 0, 65535 and a PGM's largest.
  std::vector<std::uint16_t> invalid = {};
  bool swapped = false;  ///< the less significant byte comes first, against both formats' rules
};

/// Reads a 16-bit grey PNG or PGM (gzip around it too) as the image of a depth camera, whatever its
/// name is. Stamp, pose and colours stay for the caller to set.
/// @throws Error that names the file and a remedy: for anything else, for images that are cut or of
///   another size than options.camera has, and for such whose bytes look swapped and
///   options.swapped is not set.
[[nodiscard]] DepthFrame read_depth_frame(const std::filesystem::path& path,
                                          const ReadDepthOptions& options);

/// The same into a frame whose memory is used again. On an Error, `frame` is what it was.
void read_depth_frame(const std::filesystem::path& path, const ReadDepthOptions& options,
                      DepthFrame& frame);

/// The same for bytes in memory. `name` stands for the file in messages.
[[nodiscard]] DepthFrame read_depth_frame_bytes(std::span<const std::byte> bytes,
                                                const std::string& name,
                                                const ReadDepthOptions& options);

}  // namespace palpate
