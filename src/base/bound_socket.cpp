// Binds UNIX sockets for their owner alone, and removes those that ended programs left behind.
#include "base/bound_socket.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr const char* kFolder = "the folder must exist and belong to you";
constexpr std::chrono::milliseconds kTurn{20};  // between tries for the folder's lock (judgement)
constexpr int kTries = 50;                      // for the folder's lock: 1 s in all (judgement)
constexpr int kBacklog = 8;                     // connections that wait to be accepted (judgement)

// Names the listener and its path, for messages.
struct Listener {
  std::string_view what;
  const std::string& path;

  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(fmt::format("{}: cannot listen on '{}': {}", what, path, why));
  }
};

struct Address {
  sockaddr_un address{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const noexcept {
    return reinterpret_cast<const sockaddr*>(&address);
  }
};

std::string words(int error) {
  return std::system_category().message(error);
}

Address address_of(const Listener& listener) {
  constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - 1;
  const std::string& path = listener.path;
  if (path.empty() || path.size() > kLongest) {
    listener.refuse(fmt::format("its name has {} characters; give 1 to {}", path.size(), kLongest));
  }
  Address to;
  to.address.sun_family = AF_UNIX;
  std::memcpy(to.address.sun_path, path.c_str(), path.size() + 1);
  to.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
  return to;
}

int open_socket(const Listener& listener, int type) {
  const int handle = ::socket(AF_UNIX, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (handle < 0) listener.refuse(words(errno));
  return handle;
}

// Lets one program at a time check and take a path: locks its folder, which leaves nothing behind.
class Turn {
 public:
  explicit Turn(const Listener& listener) {
    const std::filesystem::path folder = std::filesystem::absolute(listener.path).parent_path();
    folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder_ < 0) listener.refuse(fmt::format("{}; {}", words(errno), kFolder));
    const auto locked = [&] { return errno == EWOULDBLOCK || errno == EINTR; };
    for (int tries = 0; ::flock(folder_, LOCK_EX | LOCK_NB) != 0 && locked(); ++tries) {
      if (tries == kTries) {
        ::close(folder_);
        listener.refuse(
            "another program keeps its folder locked; choose a path in a folder of your own");
      }
      std::this_thread::sleep_for(kTurn);
    }
  }
  ~Turn() { ::close(folder_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int folder_ = -1;
};

// A socket file is left over when no program listens behind it. A probe for datagrams connects to
// no stream, so that a program that is there does not see it.
bool left_over(const Address& address) noexcept {
  const int probe = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (probe < 0) return false;
  const bool refused = ::connect(probe, address.get(), address.size) != 0 && errno == ECONNREFUSED;
  ::close(probe);
  return refused;
}

void make_room(const Listener& listener, const Address& address) {
  struct stat file {};
  if (::lstat(listener.path.c_str(), &file) != 0) return;
  if (!S_ISSOCK(file.st_mode)) listener.refuse("it is a file, not a socket; give another path");
  if (!left_over(address)) {
    listener.refuse("another program is listening there; stop it or give another path");
  }
  ::unlink(listener.path.c_str());
}

// The mode is that of the socket when it is bound: nobody else could ever open it.
void bind_privately(int handle, const Listener& listener, const Address& address) {
  if (::fchmod(handle, S_IRUSR | S_IWUSR) != 0 ||
      ::bind(handle, address.get(), address.size) != 0) {
    listener.refuse(fmt::format("{}; {}", words(errno), kFolder));
  }
}

}  // namespace

BoundSocket::BoundSocket(std::string_view what, const std::string& path, Kind kind) : path_(path) {
  const Listener listener{what, path};
  const Address address = address_of(listener);
  const Turn turn(listener);
  make_room(listener, address);
  handle_ = open_socket(listener, kind == Kind::stream ? SOCK_STREAM : SOCK_DGRAM);
  try {
    bind_privately(handle_, listener, address);
    if (kind == Kind::stream && ::listen(handle_, kBacklog) != 0) listener.refuse(words(errno));
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

BoundSocket::~BoundSocket() {
  struct stat file {};
  const bool ours = ::lstat(path_.c_str(), &file) == 0 && S_ISSOCK(file.st_mode) &&
                    file.st_dev == device_ && file.st_ino == inode_;
  if (ours) ::unlink(path_.c_str());
  ::close(handle_);
}

std::string runtime_path(std::string_view what, std::string_view name) {
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder == nullptr || *folder == '\0') {
    throw Error(
        fmt::format("{}: XDG_RUNTIME_DIR is not set, so there is no default path for its socket; "
                    "give a path",
                    what));
  }
  return fmt::format("{}/{}", folder, name);
}

}  // namespace palpate
