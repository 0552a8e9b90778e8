#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palpate::io {

/// Bytes under a path, for libraries that read nothing but files: a file in memory (Linux memfd),
/// gone with this object.
class MemoryFile {
 public:
  /// @throws Error when the system grants no such file, or no room for it.
  explicit MemoryFile(std::span<const std::byte> bytes);
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile();

  [[nodiscard]] std::string path() const;

 private:
  int fd_;
};

}  // namespace palpate::io
