#include "device/datagram_socket.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr const char* kFolder = "the folder must exist and belong to you";
constexpr std::size_t kHead = offsetof(sockaddr_un, sun_path);

struct Native {
  sockaddr_un address{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const noexcept {
    return reinterpret_cast<const sockaddr*>(&address);
  }
  [[nodiscard]] sockaddr* get() noexcept { return reinterpret_cast<sockaddr*>(&address); }
};

Native native(const char* path, std::size_t size) noexcept {
  Native to;
  to.address.sun_family = AF_UNIX;
  std::memcpy(to.address.sun_path, path, size);
  to.size = static_cast<socklen_t>(kHead + size);
  return to;
}

std::string words(int error) {
  return std::system_category().message(error);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(fmt::format("remote device: cannot listen on '{}': {}", path, why));
}

Native address_of(const std::string& path) {
  constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - 1;
  if (path.empty() || path.size() > kLongest) {
    refuse(path, fmt::format("its name has {} characters; give 1 to {}", path.size(), kLongest));
  }
  return native(path.c_str(), path.size() + 1);
}

int open_socket(const std::string& path) {
  const int handle = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (handle < 0) refuse(path, words(errno));
  return handle;
}

// One program at a time may look whether a path is free and take it: a lock on its folder, which
// leaves nothing behind.
class Turn {
 public:
  explicit Turn(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ < 0) refuse(path, fmt::format("{}; {}", words(errno), kFolder));
    while (::flock(folder_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~Turn() { ::close(folder_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int folder_ = -1;
};

// A socket file is left over when no program listens behind it.
bool left_over(const Native& address) noexcept {
  const int probe = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (probe < 0) return false;
  const bool refused = ::connect(probe, address.get(), address.size) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  return refused;
}

void make_room(const std::string& path, const Native& address) {
  struct stat file {};
  if (::lstat(path.c_str(), &file) != 0) return;
  if (!S_ISSOCK(file.st_mode)) refuse(path, "it is a file, not a socket; give another path");
  if (!left_over(address)) {
    refuse(path, "another program is listening there; stop it or give another path");
  }
  ::unlink(path.c_str());
}

// The mode is that of the socket when it is bound: nobody else could ever open it.
void bind_privately(int handle, const std::string& path, const Native& address) {
  if (::fchmod(handle, S_IRUSR | S_IWUSR) != 0 ||
      ::bind(handle, address.get(), address.size) != 0) {
    refuse(path, fmt::format("{}; {}", words(errno), kFolder));
  }
}

}  // namespace

DatagramSocket::DatagramSocket(const std::string& path) : path_(path) {
  const Native address = address_of(path);
  const Turn turn(path);
  make_room(path, address);
  handle_ = open_socket(path);
  try {
    bind_privately(handle_, path, address);
  } catch (...) {
    ::close(handle_);
    throw;
  }
  struct stat file {};
  if (::lstat(path.c_str(), &file) == 0) {
    device_ = file.st_dev;
    inode_ = file.st_ino;
  }
}

DatagramSocket::~DatagramSocket() {
  struct stat file {};
  const bool ours = ::lstat(path_.c_str(), &file) == 0 && S_ISSOCK(file.st_mode) &&
                    file.st_dev == device_ && file.st_ino == inode_;
  if (ours) ::unlink(path_.c_str());
  ::close(handle_);
}

Reception DatagramSocket::receive(std::span<std::byte> bytes) noexcept {
  Native from;
  from.size = sizeof from.address;
  const ssize_t size =
      ::recvfrom(handle_, bytes.data(), bytes.size(), MSG_DONTWAIT, from.get(), &from.size);
  Reception result;
  if (size < 0) {
    const bool nothing = errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    result.error = nothing ? 0 : errno;
    return result;
  }
  result.any = true;
  result.size = static_cast<std::size_t>(size);
  result.from.size = std::min(from.size > kHead ? from.size - kHead : 0, result.from.path.size());
  std::memcpy(result.from.path.data(), from.address.sun_path, result.from.size);
  return result;
}

bool DatagramSocket::send(std::span<const std::byte> bytes, const SocketAddress& to) noexcept {
  const Native address = native(to.path.data(), to.size);
  const ssize_t sent = ::sendto(handle_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                                address.get(), address.size);
  return sent == static_cast<ssize_t>(bytes.size());
}

}  // namespace palpate
