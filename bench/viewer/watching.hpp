#pragma once

#include <cstdint>
#include <future>
#include <latch>
#include <string>
#include <vector>

#include "viewer/viewer_client.hpp"

namespace palpate::viewer_bench {

constexpr int kClients = 8;

/// Eight clients of a viewer, each on a thread of its own; the last says hello and never reads.
class Watching {
 public:
  Watching(std::uint16_t port, const std::string& token);

  /// Until each of those that read has its first cloud, or will have none.
  void wait_for_clouds() { arrived_.wait(); }
  /// Of those that read, once the viewer is gone. Once.
  [[nodiscard]] std::vector<ClientReport> reports();

 private:
  std::latch arrived_{kClients - 1};
  std::vector<ViewerClient> clients_;
  std::vector<std::future<ClientReport>> reading_;
};

}  // namespace palpate::viewer_bench
