#include "viewer/raw_client.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

namespace palpate::test {
namespace {

constexpr time_t kPatience = 60;  // s
constexpr std::array<char, 4> kMask{0x12, 0x34, 0x56, 0x78};

}  // namespace

std::string local(std::uint16_t port) {
  return fmt::format("127.0.0.1:{}", port);
}

RawClient::RawClient(std::uint16_t port, Loopback loopback)
    : socket_(
          ::socket(loopback == Loopback::v4 ? AF_INET : AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval patience{kPatience, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  if (connect(port, loopback)) return;
  ::close(socket_);
  throw std::runtime_error("cannot connect");
}

bool RawClient::connect(std::uint16_t port, Loopback loopback) const {
  if (loopback == Loopback::v6) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_port = htons(port);
    address.sin6_addr = in6addr_loopback;
    return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

RawClient::~RawClient() {
  ::close(socket_);
}

void RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) throw std::runtime_error("cannot send");
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void RawClient::flood(std::string_view bytes) {
  const timeval soon{0, 20'000};
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &soon, sizeof soon);
  while (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0) continue;
}

bool RawClient::fill() {
  std::array<char, 65536> bytes;
  const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) throw std::runtime_error("silence");
  if (size <= 0) return false;
  read_.append(bytes.data(), static_cast<std::size_t>(size));
  return true;
}

std::string RawClient::take(std::size_t size) {
  while (read_.size() < size) {
    if (!fill()) throw std::runtime_error("the connection ended");
  }
  std::string taken = read_.substr(0, size);
  read_.erase(0, size);
  return taken;
}

bool RawClient::ends() {
  while (fill()) read_.clear();
  return true;
}

std::string RawClient::read_header() {
  std::size_t end = std::string::npos;
  while ((end = read_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) throw std::runtime_error("the connection ended");
  }
  return take(end + 4);
}

std::string RawClient::read_body(const std::string& header) {
  const std::string name = "Content-Length: ";
  const std::size_t at = header.find(name);
  if (at == std::string::npos) throw std::runtime_error("a body of no length");
  return take(std::stoul(header.substr(at + name.size())));
}

std::string RawClient::upgrade(const std::string& host, const std::string& origin) {
  send(fmt::format(
      "GET /live HTTP/1.1\r\nHost: {}\r\n{}Connection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
      host, origin.empty() ? "" : fmt::format("Origin: {}\r\n", origin)));
  return read_header();
}

std::string client_frame(int opcode, std::string_view payload) {
  std::string frame{static_cast<char>(0x80 | opcode)};
  if (payload.size() < 126) {
    frame += static_cast<char>(0x80 | payload.size());
  } else if (payload.size() < 65536) {
    frame += static_cast<char>(0x80 | 126);
    for (int shift = 8; shift >= 0; shift -= 8) frame += static_cast<char>(payload.size() >> shift);
  } else {
    frame += static_cast<char>(0x80 | 127);
    for (int shift = 56; shift >= 0; shift -= 8)
      frame += static_cast<char>(payload.size() >> shift);
  }
  frame.append(kMask.data(), kMask.size());
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame += static_cast<char>(payload[i] ^ kMask[i % kMask.size()]);
  }
  return frame;
}

Frame RawClient::receive() {
  Frame whole;
  while (true) {
    const std::string head = take(2);
    const int opcode = head[0] & 0x0f;
    std::uint64_t size = static_cast<unsigned char>(head[1]);
    if (size >= 126) {
      const std::string longer = take(size == 126 ? 2 : 8);
      size = 0;
      for (const char byte : longer) size = size << 8 | static_cast<unsigned char>(byte);
    }
    if (opcode != 0) whole.opcode = opcode;
    whole.payload += take(static_cast<std::size_t>(size));
    if ((head[0] & 0x80) != 0) return whole;
  }
}

nlohmann::json RawClient::receive_json(const std::string& type) {
  nlohmann::json found;
  receive_until([&](const Frame& frame) {
    if (frame.opcode != 1) return false;
    found = nlohmann::json::parse(frame.payload);
    return found["type"] == type;
  });
  return found;
}

int RawClient::receive_close() {
  try {
    return receive_until([](const Frame& frame) { return frame.opcode == 8; }).code();
  } catch (const std::runtime_error&) {
    return 0;
  }
}

}  // namespace palpate::test
