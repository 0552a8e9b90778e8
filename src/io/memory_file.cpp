#include "io/memory_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "palpate/base/error.hpp"

namespace palpate::io {

MemoryFile::MemoryFile(std::span<const std::byte> bytes)
    : fd_(::memfd_create("palpate", MFD_CLOEXEC)) {
  while (fd_ >= 0 && !bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      ::close(fd_);
      fd_ = -1;
      break;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  if (fd_ < 0) {
    throw Error(
        fmt::format("a file in memory: {}. Free some memory and try again.", std::strerror(errno)));
  }
}

MemoryFile::~MemoryFile() {
  ::close(fd_);
}

std::string MemoryFile::path() const {
  return fmt::format("/proc/self/fd/{}", fd_);
}

}  // namespace palpate::io
