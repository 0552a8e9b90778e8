#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/progress.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

struct Mesh;

/// The unit that the caller gives; metres, which are assumed, where he does not.
[[nodiscard]] FileUnit given_unit(const ReadOptions& options);

/// Input of every reader: bytes, their name for messages, and the caller's options.
struct Input {
  std::span<const std::byte> bytes;
  std::string name;
  const ReadOptions& options;
  std::filesystem::path folder{};  ///< of the file, where others may lie beside it; empty: none
  Mesh* faces = nullptr;  ///< takes the file's faces, which then become no points; null: they do
  FileUnit unit = given_unit(options);

  /// m a unit along x, y and z.
  [[nodiscard]] Eigen::Vector3d scale() const { return {unit.plan, unit.plan, unit.height}; }

  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Recognises UTF-16 by its byte order mark; some programs on Windows write it.
[[nodiscard]] inline bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}

/// Throws Error "NAME: what. Remedy."
[[noreturn]] void fail(const Input& input, std::string_view what, std::string_view remedy);

/// Throws Error "NAME, byte N: what. Remedy."
[[noreturn]] void fail_at_byte(const Input& input, std::size_t offset, std::string_view what,
                               std::string_view remedy);

/// Throws Error "NAME, line N: what. Remedy." for the line that holds byte `offset`.
[[noreturn]] void fail_at_line(const Input& input, std::size_t offset, std::string_view what,
                               std::string_view remedy);

/// Foreign text made fit for a message: cut to 40 characters, unprintable ones replaced.
[[nodiscard]] std::string excerpt(std::string_view text);

/// With capital letters A to Z made small.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The last extension of a name, lower case, with its dot: ".las"; "" without one.
[[nodiscard]] std::string extension(std::string_view name);

/// The file and the number in "house.e57#2", the second scan in it; other names have no number.
struct ScanName {
  std::string file;
  std::optional<std::size_t> number{};
};
[[nodiscard]] ScanName split_scan(const std::string& name);

/// Reports to the caller's callback how far a read has come, about a hundred times in all, so that
/// it costs a comparison a point.
class Progress {
 public:
  /// `total`: whatever is counted (bytes, points). `options` must outlive this.
  Progress(const ReadOptions& options, std::size_t total)
      : options_(options),
        total_(std::max<std::size_t>(total, 1)),
        stride_(total_ / kReports + 1),
        next_(stride_) {}

  void at(std::size_t done) {
    if (done >= next_) report(done);
  }

 private:
  static constexpr std::size_t kReports = 100;

  void report(std::size_t done) {
    next_ = done + stride_;
    detail::tell(options_.progress,
                 std::min(1.0, static_cast<double>(done) / static_cast<double>(total_)));
  }

  const ReadOptions& options_;
  std::size_t total_;
  std::size_t stride_;
  std::size_t next_;
};

enum class FileKind { ply, pcd, las, e57, obj, stl, gltf, xyz, ptx, npy, png, pgm, spz, splat, gz };

/// Kind of the file: by its first bytes, for text also by its first words, and by the name last.
/// @throws Error with the remedy for kinds that are recognised but not read (xz, JPEG, JSON,
///   a web page, ...) and for bytes of no recognised kind.
[[nodiscard]] FileKind kind_of(const Input& input);

}  // namespace palpate::io
