#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <optional>
#include <span>
#include <string>

#include "device/remote_protocol.hpp"
#include "support/folder.hpp"

namespace palpate::test {

inline sockaddr_un socket_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

/// A client's socket that sends whatever it is told to.
class RemoteClient {
 public:
  /// `own`: the path that it is bound to; empty: none.
  RemoteClient(std::string device, std::string own)
      : device_(std::move(device)),
        own_(std::move(own)),
        handle_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    if (own_.empty()) return;
    const sockaddr_un address = socket_address(own_);
    static_cast<void>(::bind(handle_, reinterpret_cast<const sockaddr*>(&address), sizeof address));
  }
  ~RemoteClient() {
    ::close(handle_);
    if (!own_.empty()) ::unlink(own_.c_str());
  }
  RemoteClient(const RemoteClient&) = delete;
  RemoteClient& operator=(const RemoteClient&) = delete;

  bool send(std::span<const std::byte> bytes) {
    const sockaddr_un address = socket_address(device_);
    return ::sendto(handle_, bytes.data(), bytes.size(), 0,
                    reinterpret_cast<const sockaddr*>(&address),
                    sizeof address) == static_cast<ssize_t>(bytes.size());
  }

  /// The next good packet, with the hand at `z`.
  bool say(double z) {
    packet_.sequence += 1;
    packet_.stamp += 1e-3;
    packet_.position.z() = z;
    return send(encode(packet_));
  }

  struct Heard {
    unsigned flags = 0;
    double z = 0;                                      // N
    Eigen::Vector3d torque = Eigen::Vector3d::Zero();  // N m; of version 2
  };
  /// The newest force that waits; none when there is none.
  std::optional<Heard> hear() {
    std::optional<Heard> heard;
    std::array<unsigned char, kLargestPacket> bytes{};
    while (::recv(handle_, bytes.data(), bytes.size(), 0) ==
           static_cast<ssize_t>(force_packet_size(packet_.version))) {
      heard.emplace();
      heard->flags = bytes[6];
      std::memcpy(&heard->z, &bytes[48], sizeof heard->z);
      std::memcpy(heard->torque.data(), &bytes[56], sizeof heard->torque);
    }
    return heard;
  }

  StatePacket& packet() { return packet_; }

 private:
  std::string device_;
  std::string own_;
  int handle_;
  StatePacket packet_;
};

}  // namespace palpate::test
