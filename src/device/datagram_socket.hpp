#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace palpate {

/// The address of a UNIX socket.
struct SocketAddress {
  std::array<char, 108> path{};  // sun_path
  std::size_t size = 0;          // of what counts in it; 0: the socket has no name

  bool operator==(const SocketAddress&) const = default;
};

/// The result of an attempt to receive.
struct Reception {
  bool any = false;      ///< a datagram came, of any size
  int error = 0;         ///< errno, if receiving failed and will go on failing
  std::size_t size = 0;  ///< bytes that were kept
  SocketAddress from;
};

/// A UNIX datagram socket bound to a path that only its owner may use (mode 0600). Neither
/// receiving nor sending waits.
class DatagramSocket {
 public:
  /// Replaces a socket file that no program has open any more.
  /// @throws Error when the path is too long, is in use or is no socket, or binding fails.
  explicit DatagramSocket(const std::string& path);
  /// Removes the file, if it still belongs to this socket.
  ~DatagramSocket();
  DatagramSocket(const DatagramSocket&) = delete;
  DatagramSocket& operator=(const DatagramSocket&) = delete;

  /// The oldest waiting datagram; cut to the size of `bytes`.
  [[nodiscard]] Reception receive(std::span<std::byte> bytes) noexcept;

  /// False: not sent; the receiver is gone, or does not read.
  bool send(std::span<const std::byte> bytes, const SocketAddress& to) noexcept;

 private:
  std::string path_;
  int handle_ = -1;
  std::uint64_t device_ = 0;  // of the file that was bound
  std::uint64_t inode_ = 0;
};

}  // namespace palpate
