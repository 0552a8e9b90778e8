// Writes files that grow, reports why they cannot, and locks the folder of work.
#include "extras/tile/out_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "palpate/base/error.hpp"

namespace palpate::io::tile {

OutFile::OutFile(const std::filesystem::path& path, std::uint64_t size)
    : name_(path.string()),
      descriptor_(::open(name_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666)),
      size_(size) {
  if (descriptor_ < 0) fail("it cannot be made");
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || static_cast<std::uint64_t>(status.st_size) < size) {
    ::close(descriptor_);
    throw Error(name_ + ": is shorter than it was. Start anew with --force.");
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("it cannot be cut");
}

OutFile::~OutFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutFile::append(std::span<const std::byte> bytes) {
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail("it cannot be written");
    }
  }
}

void OutFile::sync() const {
  if (::fsync(descriptor_) != 0) fail("it cannot be brought to the disk");
}

void OutFile::fail(const char* what) const {
  throw Error(fmt::format("{}: {} ({}). Make room or correct that, then run it again: it goes on.",
                          name_, what, std::strerror(errno)));
}

void write_file(const std::filesystem::path& path,
                std::initializer_list<std::span<const std::byte>> parts) {
  std::filesystem::path growing = path;
  growing += ".new";
  OutFile file(growing, 0);
  for (const std::span<const std::byte> part : parts) file.append(part);
  file.sync();
  std::filesystem::rename(growing, path);
}

Locked::Locked(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw Error(folder.string() +
              ": another program writes a store there. Wait until it is done, or name another "
              "folder.");
}

Locked::~Locked() {
  ::close(descriptor_);
}

}  // namespace palpate::io::tile
