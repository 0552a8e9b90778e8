// Reads bytes at any offset of a regular file.
#include "bag/random_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace palpate::bag {

RandomFile::RandomFile(std::string path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe has no end
  struct stat facts = {};
  if (file_ < 0 || ::fstat(file_, &facts) != 0) {
    throw Error(fmt::format("{}: cannot be read: {}; check the name", path_, std::strerror(errno)));
  }
  if (!S_ISREG(facts.st_mode)) {
    ::close(file_);
    throw Error(path_ + ": is no plain file; name a file that ends with .mcap");
  }
  size_ = static_cast<std::uint64_t>(facts.st_size);
}

RandomFile::~RandomFile() {
  ::close(file_);
}

Bytes RandomFile::read(std::uint64_t at, std::uint64_t length) const {
  if (at > size_ || length > size_ - at) throw Error("the file ends before");
  if (length > kLargestChunk + (16 << 20)) {
    throw Error(fmt::format("{} bytes in one piece are refused", length));
  }
  Bytes bytes(length);
  for (std::size_t done = 0; done < length;) {
    const ssize_t got =
        ::pread(file_, bytes.data() + done, length - done, static_cast<off_t>(at + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Error(got < 0 ? std::strerror(errno) : "the file became shorter");
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace palpate::bag
