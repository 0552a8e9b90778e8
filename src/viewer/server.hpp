#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "palpate/viewer/viewer.hpp"
#include "viewer/access.hpp"
#include "viewer/client_sessions.hpp"

namespace palpate::viewer {

/// The network's side of a viewer: accepts connections, checks on them, and runs what is posted.
/// All of it on the one thread that calls run().
class Server {
 public:
  /// Listens. `sessions` outlive it.
  /// @throws Error when the address or the port cannot be had.
  Server(const ViewerOptions& options, ClientSessions& sessions);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] const Listening& listening() const;
  /// @throws Error if the system has no file descriptor left.
  [[nodiscard]] std::shared_ptr<const ListeningPort> keep_listening() const;

  /// Calls `act` again and again on the network thread, `period` s apart. Before run().
  void every(double period, std::function<void()> act);
  /// Until stop(); then no connection is left.
  void run();
  /// Any thread.
  void stop();
  /// Does `act` on the network thread. Any thread.
  void post(std::function<void()> act);
  /// Clients receive `why` when they are closed at the end. Network thread.
  void restarts(std::string why);
  /// Network thread.
  [[nodiscard]] Viewer::Counts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct PageFile {
  std::string_view path;  ///< "/app.js"
  std::string_view type;  ///< MIME
  std::string_view bytes;
};

/// The page's files, held in the program. Where the page was not built, one that explains how to.
[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace palpate::viewer
