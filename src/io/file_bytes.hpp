#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "io/input.hpp"

namespace palpate::io {

/// Bytes that this object owns, not cleared before they are written.
class Bytes {
 public:
  Bytes() = default;
  explicit Bytes(std::size_t size)
      : data_(std::make_unique_for_overwrite<std::byte[]>(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<std::byte> span() { return {data_.get(), size_}; }
  [[nodiscard]] std::span<const std::byte> span() const { return {data_.get(), size_}; }

  /// Changes the size; what is there stays.
  void resize(std::size_t size);

 private:
  std::unique_ptr<std::byte[]> data_;
  std::size_t size_ = 0;
};

/// The whole of a file, or of standard input when `path` is "-". Read, not mapped: a file that
/// another program cuts short meanwhile gives an error instead of a bus fault.
/// @throws Error that names the path and the reason: absent, a folder, no permission, a device.
[[nodiscard]] Bytes read_bytes(const std::filesystem::path& path);

/// A file that is read piecewise, by several threads at once.
class OpenFile {
 public:
  /// @throws Error as read_bytes() does; of standard input and pipes, too.
  explicit OpenFile(const std::filesystem::path& path);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t size() const { return size_; }  ///< bytes, when it was opened

  /// @throws Error where the file ends before that, or reading fails: names the `part` of the file.
  [[nodiscard]] Bytes read(std::size_t offset, std::size_t size, std::string_view part = "") const;

 private:
  std::string name_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

/// Bytes that are read piecewise, of a file or in memory.
struct Parts {
  std::size_t size = 0;  ///< of all
  std::function<Bytes(std::size_t offset, std::size_t size)> read;
};
[[nodiscard]] Parts parts_of(const OpenFile& file);              ///< which outlives them
[[nodiscard]] Parts parts_of(std::span<const std::byte> bytes);  ///< which outlive them

/// The most bytes that so many packed ones may become: 64 MiB or 250 times as many. No honest
/// cloud grows beyond that (judgement).
[[nodiscard]] std::size_t largest_unpacked(std::size_t packed);

/// The bytes inside gzip (one member or several in a row). Refuses what grows beyond
/// largest_unpacked().
/// `most`: bytes after which it may stop. @throws Error for broken, cut or oversized data.
[[nodiscard]] Bytes gunzip(const Input& input,
                           std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace palpate::io
