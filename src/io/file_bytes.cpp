// Reads whole files and standard input, and unpacks gzip, within limits.
#include "io/file_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate::io {
namespace {

// Bytes; a pipe may never end (judgement)
constexpr std::uint64_t kLongestStream = std::uint64_t{16} << 30U;
constexpr std::size_t kBlock = std::size_t{1} << 20U;  // bytes read at once (judgement)

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
    std::error_code gone;
    const std::string folder = std::filesystem::current_path(gone).string();
    throw Error(fmt::format("{}: no such file. Check the path; relative ones start at {}.", name,
                            gone ? "a folder that is there no more" : folder));
  }
  if (error == EACCES) {
    throw Error(name + ": no permission to read it. Try: chmod u+r on the file (and u+x on its " +
                "folders), or run as its owner.");
  }
  throw Error(
      fmt::format("{}: cannot be opened ({}). Check the path.", name, std::strerror(error)));
}

[[noreturn]] void fail_reading(const std::string& name, int error) {
  throw Error(fmt::format("{}: reading failed ({}). Check the disk or the network, then try again.",
                          name, std::strerror(error)));
}

int open_to_read(const std::string& name) {
  const int descriptor = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail_open(name, errno);
  return descriptor;
}

// Refuses folders.
struct stat status_of(int descriptor, const std::string& name) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_open(name, errno);
  if (S_ISDIR(status.st_mode)) {
    throw Error(name + ": is a folder, not a file. Give a file in it.");
  }
  return status;
}

void check_regular(const struct stat& status, const std::string& name) {
  if (S_ISREG(status.st_mode)) return;
  throw Error(name +
              ": is a device or socket, not a file. Give a file, or \"-\" to read standard input.");
}

std::size_t read_some(int fd, std::span<std::byte> into, const std::string& name) {
  while (true) {
    const ssize_t got = ::read(fd, into.data(), into.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) fail_reading(name, errno);
  }
}

// Reads until `bytes` is full or the file ends.
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
    if (std::uint64_t{done} >= kLongestStream) {
      throw Error(
          name +
          ": still not finished after 16 GiB. Write it to a file and split it into tiles first.");
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
  const Descriptor file(open_to_read(name));
  const struct stat status = status_of(file.get(), name);
  if (S_ISFIFO(status.st_mode)) return read_stream(file.get(), name);
  check_regular(status, name);
  Bytes bytes(static_cast<std::size_t>(status.st_size));
  const std::size_t done = read_full(file.get(), bytes.span(), name);
  if (done < bytes.size()) {
    throw Error(
        fmt::format("{}: was truncated from {} to {} bytes while it was read. Wait until the other "
                    "program is done, then try again.",
                    name, bytes.size(), done));
  }
  return bytes;
}

OpenFile::OpenFile(const std::filesystem::path& path)
    : name_(path.string()), descriptor_(open_to_read(name_)) {
  try {
    const struct stat status = status_of(descriptor_, name_);
    check_regular(status, name_);
    size_ = static_cast<std::size_t>(status.st_size);
  } catch (const Error&) {
    ::close(descriptor_);
    throw;
  }
}

OpenFile::~OpenFile() {
  ::close(descriptor_);
}

Bytes OpenFile::read(std::size_t offset, std::size_t size, std::string_view part) const {
  Bytes bytes(size);
  std::size_t done = 0;
  while (done < size) {
    const std::span<std::byte> rest = bytes.span().subspan(done);
    const ssize_t got =
        ::pread(descriptor_, rest.data(), rest.size(), static_cast<off_t>(offset + done));
    if (got > 0) {
      done += static_cast<std::size_t>(got);
    } else if (got == 0) {
      throw Error(
          fmt::format("{}, byte {}: the file ends here{}{}, {} bytes too early. Copy it again.",
                      name_, offset + done, part.empty() ? "" : ", inside ", part, size - done));
    } else if (errno != EINTR) {
      fail_reading(
          fmt::format("{}, byte {}{}{}", name_, offset + done, part.empty() ? "" : ", ", part),
          errno);
    }
  }
  return bytes;
}

Parts parts_of(const OpenFile& file) {
  return {file.size(), [&](std::size_t at, std::size_t size) { return file.read(at, size); }};
}

Parts parts_of(std::span<const std::byte> bytes) {
  return {bytes.size(), [=](std::size_t offset, std::size_t size) {
            Bytes part(size);
            std::ranges::copy(bytes.subspan(offset, size), part.span().begin());
            return part;
          }};
}

namespace {

constexpr std::size_t kAlwaysAllowed = std::size_t{64} << 20U, kLargestRatio = 250;
constexpr int kGzipWindow = 15 + 16;  // zlib: gzip header, largest window

// zlib's state, released whatever happens. A gzip member ends; the next one needs a reset.
class Inflater {
 public:
  explicit Inflater(const Input& input) {
    if (inflateInit2(&stream_, kGzipWindow) != Z_OK) {
      fail(input, "zlib cannot start", "Free some memory");
    }
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream_); }
  z_stream& operator*() { return stream_; }

 private:
  z_stream stream_{};
};

uInt chunk(std::size_t size) {
  return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max() / 2));
}

std::size_t first_guess(std::size_t packed, std::size_t most) {
  return std::min(
      most, std::clamp<std::size_t>(packed * 4, std::size_t{1} << 12U, std::size_t{1} << 30U));
}

class Gunzip {
 public:
  Gunzip(const Input& input, std::size_t most)
      : input_(input), inflater_(input), out_(first_guess(input.bytes.size(), most)), most_(most) {}

  Bytes run() {
    while (done_ < most_) {
      const int status = step();
      if (status == Z_STREAM_END) {
        if (!next_member()) break;
      } else if (status != Z_OK && status != Z_BUF_ERROR) {
        fail_at_byte(input_, in_, "the gzip data is damaged",
                     "Download the file again; \"gzip -t\" tests it");
      } else if (in_ == input_.bytes.size() && done_ < out_.size()) {
        fail(input_, "the gzip data ends early: the file is truncated", "Download it again");
      }
      if (done_ == out_.size()) grow();
    }
    out_.resize(done_);
    return std::move(out_);
  }

 private:
  int step() {
    z_stream& z = *inflater_;
    const uInt given_in = chunk(input_.bytes.size() - in_);
    const uInt given_out = chunk(out_.size() - done_);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(input_.bytes.data() + in_));
    z.avail_in = given_in;
    z.next_out = reinterpret_cast<Bytef*>(out_.span().data() + done_);
    z.avail_out = given_out;
    const int status = inflate(&z, Z_NO_FLUSH);
    in_ += given_in - z.avail_in;
    done_ += given_out - z.avail_out;
    return status;
  }

  // Some programs pad with zeros behind the last member: that is an end too.
  bool next_member() {
    const auto rest = input_.bytes.subspan(in_);
    if (rest.size() < 2 || rest[0] != std::byte{0x1f} || rest[1] != std::byte{0x8b}) return false;
    return inflateReset(&*inflater_) == Z_OK;
  }

  void grow() {
    const std::size_t allowed = largest_unpacked(input_.bytes.size());
    if (out_.size() >= allowed) {
      fail(input_,
           fmt::format("unpacks to more than {} MiB, over {} times its size", allowed >> 20U,
                       kLargestRatio),
           "If you trust it, unpack it with gunzip and read the result");
    }
    out_.resize(std::min(2 * out_.size(), allowed));
  }

  const Input& input_;
  Inflater inflater_;
  Bytes out_;
  std::size_t most_;
  std::size_t in_ = 0;
  std::size_t done_ = 0;
};

}  // namespace

std::size_t largest_unpacked(std::size_t packed) {
  constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
  return std::max(kAlwaysAllowed, kLargestRatio * std::min(packed, kMost / kLargestRatio));
}

Bytes gunzip(const Input& input, std::size_t most) {
  return Gunzip(input, most).run();
}

}  // namespace palpate::io
