#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <latch>
#include <memory>
#include <string>
#include <vector>

namespace palpate::viewer_bench {

/// Counts of a client until its connection ended.
struct ClientReport {
  std::size_t points = 0;      ///< of the first cloud that was not empty
  double seconds_to_them = 0;  ///< from hello until that cloud was there whole
  double seconds = 0;          ///< from hello until the end
  std::uint64_t bytes = 0;     ///< of messages
  std::uint64_t states = 0;
  std::uint64_t clouds = 0;
  std::uint64_t surfaces = 0;
};

/// A page that draws nothing: a WebSocket to a viewer on this machine.
class ViewerClient {
 public:
  /// Connects and says hello.
  /// @throws std::exception where there is no viewer.
  ViewerClient(std::uint16_t port, const std::string& token);
  ~ViewerClient();
  ViewerClient(ViewerClient&&) noexcept;
  ViewerClient& operator=(ViewerClient&&) noexcept;

  /// Reads until the connection ends, and calls `arrived` when the first cloud is there, or when
  /// none will come. Who never calls it never reads.
  [[nodiscard]] ClientReport watch(const std::function<void()>& arrived);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

constexpr int kClients = 8;  ///< judgement: more pages than one person opens

/// Eight clients of a viewer, each on a thread of its own; the last says hello and never reads.
class Watching {
 public:
  Watching(std::uint16_t port, const std::string& token);

  /// Until each of those that read has its first cloud, or will have none.
  void wait_for_clouds() { arrived_.wait(); }
  /// Reports of the clients that read. Call it once, after the viewer is gone.
  [[nodiscard]] std::vector<ClientReport> reports();

 private:
  std::latch arrived_{kClients - 1};
  std::vector<ViewerClient> clients_;
  std::vector<std::future<ClientReport>> reading_;
};

}  // namespace palpate::viewer_bench
