#include "io/file_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kLongestStream = std::size_t{16} << 30U;  // bytes; a pipe may never end
constexpr std::size_t kBlock = std::size_t{1} << 20U;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ > STDIN_FILENO) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void fail_open(const std::string& name, int error) {
  if (error == ENOENT) {
    throw Error(name + ": no such file. Check the path; relative ones start at " +
                std::filesystem::current_path().string() + ".");
  }
  if (error == EACCES) {
    throw Error(name +
                ": no permission to read it. Try: chmod u+r on the file (and u+x on its "
                "folders), or run as its owner.");
  }
  throw Error(
      fmt::format("{}: cannot be opened ({}). Check the path.", name, std::strerror(error)));
}

std::size_t read_some(int fd, std::span<std::byte> into, const std::string& name) {
  while (true) {
    const ssize_t got = ::read(fd, into.data(), into.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) {
      throw Error(
          fmt::format("{}: reading failed ({}). Check the disk or the network, then try "
                      "again.",
                      name, std::strerror(errno)));
    }
  }
}

// As much as there is, up to the end of `bytes`.
std::size_t read_full(int fd, std::span<std::byte> bytes, const std::string& name) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const std::size_t got = read_some(fd, bytes.subspan(done), name);
    if (got == 0) break;
    done += got;
  }
  return done;
}

Bytes read_stream(int fd, const std::string& name) {
  Bytes bytes(kBlock);
  std::size_t done = 0;
  while (true) {
    done += read_full(fd, bytes.span().subspan(done), name);
    if (done < bytes.size()) break;
    if (done >= kLongestStream) {
      throw Error(name +
                  ": more than 16 GiB without an end. Write it to a file and cut it into "
                  "tiles first.");
    }
    bytes.resize(2 * bytes.size());
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace

void Bytes::resize(std::size_t size) {
  Bytes other(size);
  if (const std::size_t kept = std::min(size, size_); kept > 0) {
    std::memcpy(other.data_.get(), data_.get(), kept);
  }
  *this = std::move(other);
}

Bytes read_bytes(const std::filesystem::path& path) {
  if (path == "-") return read_stream(STDIN_FILENO, "standard input");
  const std::string name = path.string();
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) fail_open(name, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail_open(name, errno);
  if (S_ISDIR(status.st_mode)) {
    throw Error(name + ": is a folder, not a file. Name one file in it.");
  }
  if (S_ISFIFO(status.st_mode)) return read_stream(file.get(), name);
  if (!S_ISREG(status.st_mode)) {
    throw Error(name +
                ": is a device or socket, not a file. Name a file, or \"-\" to read "
                "standard input.");
  }
  Bytes bytes(static_cast<std::size_t>(status.st_size));
  const std::size_t done = read_full(file.get(), bytes.span(), name);
  if (done < bytes.size()) {
    throw Error(
        fmt::format("{}: was cut from {} to {} bytes while it was read. Wait until the "
                    "other program is done, then try again.",
                    name, bytes.size(), done));
  }
  return bytes;
}

}  // namespace palpate::io
