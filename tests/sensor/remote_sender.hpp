#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "base/little_endian.hpp"
#include "sensor/remote_frame.hpp"

namespace palpate::test {

/// A frame as docs/remote_camera.md describes it, good or not: 8 x 6 pixels of 0.7 m unless told.
struct RemoteFrame {
  std::array<char, 4> magic{'p', 'l', 'p', 'D'};
  std::uint16_t version = 1;
  std::uint16_t flags = 0;
  std::uint32_t width = 8;
  std::uint32_t height = 6;
  double unit = 1e-3;
  std::array<double, 4> lens{8, 8.5, 3.5, 2.5};  // fx fy cx cy
  std::array<double, 5> distortion{};
  double stamp = 0;
  std::array<double, 7> pose{0, 0, 0, 0, 0, 0, 1};
  std::vector<std::uint16_t> steps = std::vector<std::uint16_t>(48, 700);
  std::vector<float> floats = {};  // in their place, where there are any

  [[nodiscard]] std::vector<std::byte> bytes() const {
    std::vector<std::byte> all(sensor::kFrameHeaderSize + 2 * steps.size() + 4 * floats.size());
    LittleEndianWriter writer(all);
    for (const char c : magic) writer.put(static_cast<std::uint8_t>(c));
    writer.put(version);
    writer.put(flags);
    writer.put(width);
    writer.put(height);
    writer.put(unit);
    for (const double x : lens) writer.put(x);
    for (const double x : distortion) writer.put(x);
    writer.put(stamp);
    for (const double x : pose) writer.put(x);
    for (const std::uint16_t v : steps) writer.put(v);
    for (const float v : floats) writer.put(std::bit_cast<std::uint32_t>(v));
    return all;
  }
};

/// A program that is a camera, and sends whatever it is told to.
class RemoteSender {
 public:
  explicit RemoteSender(const std::string& path) : handle_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    connected_ =
        ::connect(handle_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~RemoteSender() { leave(); }
  RemoteSender(const RemoteSender&) = delete;
  RemoteSender& operator=(const RemoteSender&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }

  /// Waits until all is sent. False: the other side has closed.
  bool send(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
    return true;
  }
  bool send(const RemoteFrame& frame) const { return send(frame.bytes()); }

  /// All that the other side said before it closed; waits for that.
  [[nodiscard]] std::string last_words() const {
    std::string words;
    std::array<char, 1000> bytes{};
    for (ssize_t got = 0; (got = ::recv(handle_, bytes.data(), bytes.size(), 0)) > 0;) {
      words.append(bytes.data(), static_cast<std::size_t>(got));
    }
    return words;
  }

  void leave() {
    if (handle_ >= 0) ::close(handle_);
    handle_ = -1;
  }

 private:
  int handle_;
  bool connected_ = false;
};

}  // namespace palpate::test
