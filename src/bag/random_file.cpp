// Reads bytes at any offset of a regular file, or of one in memory.
#include "bag/random_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace palpate::bag {

namespace {

std::shared_ptr<const int> closing(int file) {
  return {new int(file), [](const int* descriptor) {
            ::close(*descriptor);
            delete descriptor;
          }};
}

}  // namespace

RandomFile::RandomFile(std::string path) : path_(std::move(path)) {
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe has no end
  struct stat facts = {};
  if (file < 0 || ::fstat(file, &facts) != 0) {
    throw Error(fmt::format("{}: cannot be read: {}; check the name", path_, std::strerror(errno)));
  }
  file_ = closing(file);
  if (!S_ISREG(facts.st_mode)) {
    throw Error(path_ + ": is no plain file; name a file that ends with .mcap");
  }
  size_ = static_cast<std::uint64_t>(facts.st_size);
}

Bytes RandomFile::read(std::uint64_t at, std::uint64_t length) const {
  if (at > size_ || length > size_ - at) throw Error("the file ends before");
  if (length > kLargestChunk + (16 << 20)) {
    throw Error(fmt::format("{} bytes in one piece are refused", length));
  }
  Bytes bytes(length);
  if (bytes_) {
    if (length > 0) std::memcpy(bytes.data(), bytes_.get() + at, length);
    return bytes;
  }
  for (std::size_t done = 0; done < length;) {
    const ssize_t got =
        ::pread(*file_, bytes.data() + done, length - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Error(got < 0 ? std::strerror(errno) : "the file became shorter");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace palpate::bag
