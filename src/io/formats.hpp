// Declares the headers, readers and encoders of each file format.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/input.hpp"
#include "io/text_scanner.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::float32;   ///< of the value, or of a list's items
  std::optional<NumberType> list_count{};  ///< type of a list's length, if it is a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes up to the first element
};

/// @throws Error that names the line of what is wrong.
[[nodiscard]] PlyHeader read_ply_header(const Input& input);

/// PLY: ascii, binary little and big endian; any order and type of properties. Points are the
/// first element that has x, y and z. Kept of a point: its normal, colour and the first scalar
/// whose name contains intensity or quality. Faces are "vertex_indices" (or "vertex_index") of the
/// element "face"; other elements and lists are skipped.
[[nodiscard]] CloudFile read_ply(const Input& input);

enum class PcdEncoding { ascii, binary, compressed };

struct PcdField {
  std::string name;
  NumberType type = NumberType::float32;
  std::size_t count = 1;   ///< numbers a point
  std::size_t offset = 0;  ///< bytes from the start of a point
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t point_size = 0;  ///< bytes of a binary point
  std::size_t width = 0;
  std::size_t height = 1;
  std::size_t points = 0;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};  ///< position, quaternion w x y z
  PcdEncoding encoding = PcdEncoding::ascii;
  std::size_t size = 0;  ///< bytes up to the data

  [[nodiscard]] bool organised() const { return height > 1; }
};

/// @throws Error that names the line of what is wrong.
[[nodiscard]] PcdHeader read_pcd_header(const Input& input);

/// Unpacks LZF, the compression of "DATA binary_compressed" in PCD files: a control byte below 32
/// announces that many + 1 bytes as they are; above, its upper three bits (7: plus the next byte)
/// hold a length - 2 and its lower five with the next byte a distance back - 1.
/// @return nothing when done; otherwise the offset in `packed` at which the data goes wrong
///   (reaches before the start, past the end, or leaves `unpacked` partly unfilled).
[[nodiscard]] std::optional<std::size_t> lzf_unpack(std::span<const std::byte> packed,
                                                    std::span<std::byte> unpacked);

/// A byte of LZF gives at most this many bytes: 264 from three.
inline constexpr std::size_t kLzfLargestRatio = 88;

/// PCD 0.5 - 0.7: ascii, binary and binary_compressed; organised or not. Kept of a point: normal,
/// colour ("rgb", "rgba": 0x00rrggbb in the bits of a float or an integer) and intensity. The
/// viewpoint is kept when the cloud is organised or the file sets one.
[[nodiscard]] CloudFile read_pcd(const Input& input);

/// Part of a LAS header that reading points needs (ASPRS LAS 1.0 - 1.4).
struct LasHeader {
  int minor_version = 0;
  std::size_t size = 0;     ///< bytes, up to its variable length records
  std::size_t records = 0;  ///< variable length records
  int format = 0;           ///< point format, 0 - 10
  bool compressed = false;  ///< LAZ
  std::size_t points_offset = 0;
  std::size_t record_size = 0;
  std::size_t points = 0;
  Eigen::Vector3d scale;  ///< coordinate = number * scale + offset
  Eigen::Vector3d offset;
  Eigen::Vector3d lower;  ///< of the coordinates, as announced: they may lie elsewhere
  Eigen::Vector3d upper;

  /// Formats from 6 on lay out a point's flags otherwise.
  [[nodiscard]] bool extended() const { return format >= 6; }
  /// The bit of a record's byte 15 that marks a point as withheld; LAS 1.0 has none.
  [[nodiscard]] std::byte withheld_mask() const;
  [[nodiscard]] std::optional<std::size_t> color_offset() const;  ///< bytes into a record
  [[nodiscard]] std::size_t extra_bytes() const;  ///< of a record, behind what its format has
  [[nodiscard]] std::string name() const;         ///< "LAS 1.2, point format 0"
};

/// @throws Error that names the byte of what is wrong.
[[nodiscard]] LasHeader read_las_header(const Input& input);

/// The bytes of a file before its points: header and variable length records.
/// @throws Error as OpenFile::read() does.
[[nodiscard]] Bytes read_las_head(const OpenFile& file);

/// The contents of a variable length record: where they are in the file, and their bytes.
struct LasRecord {
  std::size_t offset = 0;
  std::size_t size = 0;
};

/// The first such record that lies within the file.
[[nodiscard]] std::optional<LasRecord> find_record(const Input& input, const LasHeader& header,
                                                   std::string_view user, int id);

/// What is kept of a point of any format. Not cleared before it is written: there are many.
struct LasPoint {
  std::array<std::int32_t, 3> number;  ///< coordinate = number * scale + offset
  std::array<std::uint16_t, 3> color;  ///< 0 in formats without
  std::uint16_t intensity;
  bool withheld;  ///< marked as not to be used
};

/// The point of a record that is not compressed.
[[nodiscard]] LasPoint las_point(const LasHeader& header, const std::byte* record);

/// LAS 1.0 - 1.4, point formats 0 - 10. Points marked withheld are dropped; intensity and colour
/// are kept unless they are zero throughout. Made for tens of millions of points: two passes over
/// the bytes, nothing held twice. LAZ (and COPC, which is LAZ) in formats 0 - 3 and 6 - 8.
[[nodiscard]] CloudFile read_las(const Input& input);

namespace laz {

/// Decoding points takes so many times as long as making a cloud of them (measured, two cores):
/// how they share the progress that is reported.
inline constexpr std::size_t kDecodingShare = 4;

/// All points of a LAZ file, decoded on all cores.
/// @throws Error that names the byte of what is wrong.
[[nodiscard]] std::unique_ptr<LasPoint[]> read_points(const Input& input, const LasHeader& header);

}  // namespace laz

/// E57: the scans that hold points, or one that the name selects ("house.e57#2"), in the file's
/// frame. Points marked invalid are dropped; of several scans the columns are kept that all have.
/// The viewpoint is kept of a single scan that a scanner made.
[[nodiscard]] CloudFile read_e57(const Input& input);

/// The numbers of the scans that hold points, from 1 on.
[[nodiscard]] std::vector<std::size_t> e57_scans_with_points(const Input& input);

/// The faces of a Wavefront OBJ file (lines "f"), or its vertices ("v x y z", with "r g b" where
/// the first vertex has them) with its normals where there are as many "vn" as "v". Everything else
/// is skipped.
[[nodiscard]] CloudFile read_obj(const Input& input);

/// STL, as text or bytes: the faces; its normals and colours are not used.
[[nodiscard]] CloudFile read_stl(const Input& input);

/// Is it an STL file? One of bytes has no mark, but the size that its count of triangles requires.
[[nodiscard]] bool is_stl(const Input& input);

/// glTF 2.0, as JSON or in one binary file (GLB): the triangles of its scene or, without any, its
/// points; y up turned to z up.
/// Data may lie in the file, or in files beside it where `input` has a folder.
/// @throws Error for compressed (Draco, meshopt) and sparse data.
[[nodiscard]] CloudFile read_gltf(const Input& input);

/// A point a line. How lines divide into cells, and whether commas are within numbers, is found
/// from the first rows and holds for all. Lines that start with #, // or % are comments; lines of
/// one whole number announce as many points each (PTS, scan by scan).
///
/// A header line, or a comment, names the columns; easting, northing and height mean x, y and z
/// where no columns are called so. Without names guess_roles() decides, but for a first column
/// that counts the rows.
/// @throws Error for columns of longitude and latitude, too.
[[nodiscard]] CloudFile read_xyz(const Input& input);

/// PTX: the points of all scans, in the world that their matrices lead to, with intensities, and
/// colours where the first point has them. Points at the scanner itself are where nothing came
/// back, and dropped. The viewpoint is kept of a single scan.
[[nodiscard]] CloudFile read_ptx(const Input& input);

/// Is it named as PTX, or do its first lines have the numbers of values that those of PTX have?
[[nodiscard]] bool is_ptx(const Input& input);

/// NumPy's .npy, an array of numbers in rows of x y z and what guess_roles() finds; or points of
/// four floats without a header, as KITTI's scanner has them: x y z and an intensity.
/// @throws Error for bytes that cannot be such.
[[nodiscard]] CloudFile read_array(const Input& input);

}  // namespace palpate::io

namespace palpate {

enum class CloudFormat { ply, pcd };

/// The bytes of a file that write_cloud() writes.
[[nodiscard]] std::string encode_cloud(const PointCloud& cloud, CloudFormat format,
                                       const WriteOptions& options = {});

}  // namespace palpate
