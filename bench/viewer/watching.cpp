#include "viewer/watching.hpp"

namespace palpate::viewer_bench {

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
