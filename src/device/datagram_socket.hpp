#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "base/bound_socket.hpp"

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

/// A BoundSocket of datagrams. Neither receiving nor sending waits.
class DatagramSocket {
 public:
  /// @throws Error as BoundSocket does.
  explicit DatagramSocket(const std::string& path)
      : bound_("remote device", path, BoundSocket::Kind::datagrams) {}

  /// The oldest waiting datagram; cut to the size of `bytes`.
  [[nodiscard]] Reception receive(std::span<std::byte> bytes) noexcept;

  /// False: not sent; the receiver is gone, or does not read.
  bool send(std::span<const std::byte> bytes, const SocketAddress& to) noexcept;

 private:
  BoundSocket bound_;
};

}  // namespace palpate
