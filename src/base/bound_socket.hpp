#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// A UNIX socket bound to a path that only its owner may use (mode 0600).
class BoundSocket {
 public:
  enum class Kind {
    datagrams,
    stream,  ///< it listens: others may connect
  };

  /// Replaces a socket file that no program has open any more. `what` is to listen there, for
  /// messages. Waits for a second at most while another program binds in the same folder.
  /// @throws Error when the path is too long, is in use or is no socket, or binding fails.
  BoundSocket(std::string_view what, const std::string& path, Kind kind);
  /// Removes the file, if it still belongs to this socket.
  ~BoundSocket();
  BoundSocket(const BoundSocket&) = delete;
  BoundSocket& operator=(const BoundSocket&) = delete;

  [[nodiscard]] int handle() const noexcept { return handle_; }

 private:
  std::string path_;
  int handle_ = -1;
  std::uint64_t device_ = 0;  // of the file that was bound
  std::uint64_t inode_ = 0;
};

/// $XDG_RUNTIME_DIR/NAME: where `what` listens unless another path is given.
/// @throws Error when there is no such variable.
[[nodiscard]] std::string runtime_path(std::string_view what, std::string_view name);

}  // namespace palpate
