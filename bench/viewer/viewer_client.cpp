// Speaks the viewer's protocol as a page that draws nothing.
#include "viewer/viewer_client.hpp"

#include <fmt/format.h>

#include <bit>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <cstring>

#include "palpate/base/clock.hpp"

namespace palpate::viewer_bench {

namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
using Tcp = net::ip::tcp;

// that it asks for; judgement: more than the bench shows
constexpr std::size_t kMostPoints = 1'000'000;
// of a message; derived: above kMostPoints of 16 bytes
constexpr std::size_t kMostBytes = 64 << 20;

// docs/viewer_protocol.md
enum Kind : std::uint8_t { kState = 1, kCloud = 2, kSurface = 3 };

std::uint32_t points_of(const char* cloud) {
  static_assert(std::endian::native == std::endian::little);
  std::uint32_t n = 0;
  std::memcpy(&n, cloud + 4, sizeof n);
  return n;
}

void take(const char* message, double time, ClientReport& report) {
  if (message[0] == kState) ++report.states;
  if (message[0] == kSurface) ++report.surfaces;
  if (message[0] != kCloud) return;
  ++report.clouds;
  if (report.points > 0) return;
  report.points = points_of(message);
  report.seconds_to_them = time;
}

}  // namespace

struct ViewerClient::Connection {
  net::io_context io;
  beast::websocket::stream<Tcp::socket> stream{io};
  double begin = SteadyClock().now();

  [[nodiscard]] double time() const { return SteadyClock().now() - begin; }
};

ViewerClient::ViewerClient(std::uint16_t port, const std::string& token)
    : connection_(std::make_unique<Connection>()) {
  auto& stream = connection_->stream;
  stream.next_layer().connect({net::ip::address_v4::loopback(), port});
  stream.read_message_max(kMostBytes);
  stream.handshake(fmt::format("127.0.0.1:{}", port), "/live");
  stream.text(true);
  stream.write(net::buffer(
      fmt::format(R"({{"type":"hello","token":"{}","points":{}}})", token, kMostPoints)));
}

ViewerClient::~ViewerClient() = default;
ViewerClient::ViewerClient(ViewerClient&&) noexcept = default;
ViewerClient& ViewerClient::operator=(ViewerClient&&) noexcept = default;

ClientReport ViewerClient::watch(const std::function<void()>& arrived) {
  ClientReport report;
  beast::flat_buffer buffer;
  beast::error_code error;
  while (true) {
    const std::size_t size = connection_->stream.read(buffer, error);
    if (error) break;
    report.bytes += size;
    const auto* message = static_cast<const char*>(buffer.data().data());
    const bool waited = report.points == 0;
    if (connection_->stream.got_binary()) take(message, connection_->time(), report);
    if (waited && report.points > 0) arrived();
    buffer.consume(buffer.size());
  }
  if (report.points == 0) arrived();
  report.seconds = connection_->time();
  return report;
}

Watching::Watching(std::uint16_t port, const std::string& token) {
  clients_.reserve(kClients);  // threads refer to them
  for (int i = 0; i < kClients; ++i) clients_.emplace_back(port, token);
  for (int i = 0; i + 1 < kClients; ++i) {
    ViewerClient& client = clients_[static_cast<std::size_t>(i)];
    reading_.push_back(std::async(std::launch::async, [this, &client] {
      return client.watch([this] { arrived_.count_down(); });
    }));
  }
}

std::vector<ClientReport> Watching::reports() {
  std::vector<ClientReport> reports;
  for (auto& reading : reading_) reports.push_back(reading.get());
  return reports;
}

}  // namespace palpate::viewer_bench
