// Sends and receives datagrams over a UNIX socket without waiting.
#include "device/datagram_socket.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace palpate {
namespace {

constexpr std::size_t kHead = offsetof(sockaddr_un, sun_path);

struct Native {
  sockaddr_un address{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const noexcept {
    return reinterpret_cast<const sockaddr*>(&address);
  }
  [[nodiscard]] sockaddr* get() noexcept { return reinterpret_cast<sockaddr*>(&address); }
};

}  // namespace

Reception DatagramSocket::receive(std::span<std::byte> bytes) noexcept {
  Native from;
  from.size = sizeof from.address;
  const ssize_t size =
      ::recvfrom(bound_.handle(), bytes.data(), bytes.size(), MSG_DONTWAIT, from.get(), &from.size);
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
  Native address;
  address.address.sun_family = AF_UNIX;
  std::memcpy(address.address.sun_path, to.path.data(), to.size);
  address.size = static_cast<socklen_t>(kHead + to.size);
  const ssize_t sent = ::sendto(bound_.handle(), bytes.data(), bytes.size(),
                                MSG_DONTWAIT | MSG_NOSIGNAL, address.get(), address.size);
  return sent == static_cast<ssize_t>(bytes.size());
}

}  // namespace palpate
