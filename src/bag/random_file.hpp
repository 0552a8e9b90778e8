#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "bag/mcap_format.hpp"

namespace palpate::bag {

/// A file that is read at any offset, or bytes in memory instead of one. Copies are of the same
/// file. Any thread.
class RandomFile {
 public:
  /// @throws Error when it cannot be read or is no plain file.
  explicit RandomFile(std::string path);
  /// The `size` bytes of a file of that name.
  RandomFile(std::string name, std::shared_ptr<const std::byte[]> bytes, std::uint64_t size)
      : path_(std::move(name)), bytes_(std::move(bytes)), size_(size) {}

  /// Size when the file was opened, bytes; it may have grown since.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// @throws Error when there are not so many bytes, and beyond kLargestChunk and a little more.
  [[nodiscard]] Bytes read(std::uint64_t at, std::uint64_t length) const;

 private:
  std::string path_;
  std::shared_ptr<const int> file_;           // its descriptor
  std::shared_ptr<const std::byte[]> bytes_;  // null: they are in the file
  std::uint64_t size_ = 0;
};

}  // namespace palpate::bag
