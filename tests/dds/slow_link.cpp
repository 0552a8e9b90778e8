// A link between two machines as bad as one likes: slow_link LINK LINK DELAY_MS LOSS_PERCENT SEED.
// Carries what comes in on either network interface to the other at 1 Gbit/s, DELAY_MS later, and
// loses some of it. Runs until it is killed. (What `tc netem` does, for kernels without it.)
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace {

constexpr int kRoom = 32 << 20;  // bytes for packets that wait in a socket
constexpr double kByte = 8e-9;   // s that a byte takes

struct Packet {
  double due = 0;  // s
  int to = -1;     // socket
  std::vector<char> bytes;
};

int socket_on(const char* link) {
  const int made = socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK, htons(ETH_P_ALL));
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(link));
  const int on = 1;
  // With it come checksums that the sender left to its network card.
  const bool ready = setsockopt(made, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof on) == 0 &&
                     setsockopt(made, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) == 0 &&
                     bind(made, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  setsockopt(made, SOL_SOCKET, SO_RCVBUFFORCE, &kRoom, sizeof kRoom);
  setsockopt(made, SOL_SOCKET, SO_SNDBUFFORCE, &kRoom, sizeof kRoom);
  if (ready) return made;
  std::perror(link);
  std::exit(1);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 6) return 2;
  const std::array<int, 2> ends = {socket_on(arguments[1]), socket_on(arguments[2])};
  const double delay = std::stod(arguments[3]) / 1e3;
  static_cast<void>(palpate::make_realtime({.priority = 60}));
  std::mt19937 random(static_cast<unsigned>(std::stoul(arguments[5])));
  std::bernoulli_distribution is_lost(std::stod(arguments[4]) / 100);
  const palpate::SteadyClock clock;
  std::array<std::deque<Packet>, 2> ways;
  std::array<double, 2> busy{};     // until then, each way
  std::vector<char> bytes(70'000);  // the longest that a socket hands over, and its head
  while (true) {
    std::array<pollfd, 2> waits = {{{ends[0], POLLIN, 0}, {ends[1], POLLIN, 0}}};
    double left = 1;
    for (const auto& packets : ways) {
      if (!packets.empty()) left = std::clamp(packets.front().due - clock.now(), 0.0, left);
    }
    const timespec time = {static_cast<time_t>(left),
                           static_cast<long>(1e9 * (left - static_cast<double>(time_t(left))))};
    ppoll(waits.data(), waits.size(), &time, nullptr);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (ssize_t size = 0; (size = recv(ends[i], bytes.data(), bytes.size(), 0)) > 0;) {
        busy[i] = std::max(busy[i], clock.now()) + kByte * static_cast<double>(size);
        if (is_lost(random)) continue;
        ways[i].push_back({busy[i] + delay, ends[1 - i], {bytes.data(), bytes.data() + size}});
      }
    }
    for (auto& packets : ways) {
      for (; !packets.empty() && packets.front().due <= clock.now(); packets.pop_front()) {
        const Packet& next = packets.front();
        static_cast<void>(write(next.to, next.bytes.data(), next.bytes.size()));
      }
    }
  }
}
