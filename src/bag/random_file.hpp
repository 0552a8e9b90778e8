#pragma once

#include <string>

#include "bag/mcap_format.hpp"

namespace palpate::bag {

/// A file that is read at any offset. One thread at a time.
class RandomFile {
 public:
  /// @throws Error when it cannot be read or is no plain file.
  explicit RandomFile(std::string path);
  ~RandomFile();
  RandomFile(const RandomFile&) = delete;
  RandomFile& operator=(const RandomFile&) = delete;

  /// Size when the file was opened, bytes; it may have grown since.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// @throws Error when there are not so many bytes, and beyond kLargestChunk and a little more.
  [[nodiscard]] Bytes read(std::uint64_t at, std::uint64_t length) const;

 private:
  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace palpate::bag
