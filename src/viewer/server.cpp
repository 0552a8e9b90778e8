#include "viewer/server.hpp"

#include <fcntl.h>
#include <fmt/core.h>

#include <chrono>
#include <deque>
#include <exception>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "viewer/beast.hpp"
#include "viewer/http_connection.hpp"

namespace palpate::viewer {
namespace {

constexpr int kPortsTried = 10;
constexpr double kCheck = 0.1;        // s between looks at waiting connections
constexpr double kAcceptAgain = 0.2;  // s, after the system would not give a socket
constexpr double kLastLook = 0.01;    // s between looks whether all have closed at the end
constexpr int kLastLooks = 20;

std::chrono::nanoseconds nanoseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(seconds));
}

net::ip::address address_of(const std::string& text) {
  beast::error_code error;
  const auto address = net::ip::make_address(text, error);
  if (!error) return address;
  throw Error(fmt::format(
      "viewer: '{}' is no address; give one like 127.0.0.1, ::1 or 0.0.0.0 (everywhere)", text));
}

// A program that this one starts (a browser) has no part in its sockets.
template <class Socket>
void keep_to_ourselves(Socket& socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
}

beast::error_code listen(Tcp::acceptor& acceptor, const Tcp::endpoint& endpoint) {
  beast::error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) keep_to_ourselves(acceptor);
  if (!error) acceptor.set_option(net::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  beast::error_code ignored;
  if (error) acceptor.close(ignored);
  return error;
}

Listening listen(Tcp::acceptor& acceptor, const ViewerOptions& options) {
  const net::ip::address address = address_of(options.address);
  const int tries = options.port ? 1 : kPortsTried;
  const std::uint16_t first = options.port.value_or(ViewerOptions::kFirstPort);
  beast::error_code error;
  for (int i = 0; i < tries; ++i) {
    error = listen(acceptor, {address, static_cast<std::uint16_t>(first + i)});
    if (error) continue;
    return {address.to_string(), acceptor.local_endpoint().port(), address.is_unspecified()};
  }
  const std::string ports = tries == 1 ? fmt::format("port {}", first)
                                       : fmt::format("any port {}-{}", first, first + tries - 1);
  throw Error(fmt::format("viewer: cannot listen on {} at {}: {}; give another address or port",
                          ports, options.address, error.message()));
}

}  // namespace

struct Server::State {
  struct Repeated {
    net::steady_timer timer;
    double period;
    std::function<void()> act;
  };

  State(const ViewerOptions& options, Lobby& lobby)
      : acceptor(io), again(io), hub{options.limits, listen(acceptor, options), lobby} {}

  void accept();
  void take(Tcp::socket socket);
  void repeat(Repeated& task);
  void check();
  void end();
  void wait_for_last_words(int looks);

  net::io_context io{1};
  Tcp::acceptor acceptor;
  net::steady_timer again;
  Hub hub;
  std::deque<Repeated> repeated;
  bool ending = false;
};

void Server::State::accept() {
  acceptor.async_accept([this](const beast::error_code& error, Tcp::socket socket) {
    if (ending) return;
    if (!error) {
      accept();  // first: what goes wrong with one socket keeps no other out
      take(std::move(socket));
      return;
    }
    again.expires_after(nanoseconds(kAcceptAgain));
    again.async_wait([this](const beast::error_code&) {
      if (!ending) accept();
    });
  });
}

void Server::State::take(Tcp::socket socket) {
  keep_to_ourselves(socket);
  ++hub.accepted;
  if (hub.connections.size() >= hub.limits.connections) {
    ++hub.turned_away;
    return;  // closes it
  }
  std::make_shared<HttpConnection>(hub, std::move(socket))->run();
}

// A time that passed is left out: no burst after a pause.
void Server::State::repeat(Repeated& task) {
  task.timer.expires_after(nanoseconds(task.period));
  task.timer.async_wait([this, &task](const beast::error_code& error) {
    if (error || ending) return;
    repeat(task);
    task.act();
  });
}

void Server::State::check() {
  const double now = Hub::now();
  hub.lobby.check(now);
  // Those that are closed leave the set later, when their operations end.
  for (Connection* connection : hub.connections) connection->check(now);
}

void Server::State::end() {
  ending = true;
  beast::error_code ignored;
  acceptor.close(ignored);
  for (Repeated& one : repeated) one.timer.cancel();
  for (Connection* connection : hub.connections) connection->end();
  wait_for_last_words(kLastLooks);
}

void Server::State::wait_for_last_words(int looks) {
  if (hub.connections.empty()) return;
  if (looks == 0) {
    for (Connection* connection : hub.connections) connection->abort();
    return;
  }
  again.expires_after(nanoseconds(kLastLook));
  again.async_wait([this, looks](const beast::error_code&) { wait_for_last_words(looks - 1); });
}

Server::Server(const ViewerOptions& options, Lobby& lobby)
    : state_(std::make_unique<State>(options, lobby)) {
  every(kCheck, [this] { state_->check(); });
}

Server::~Server() = default;

const Listening& Server::listening() const {
  return state_->hub.listening;
}

void Server::every(double period, std::function<void()> act) {
  state_->repeat(state_->repeated.emplace_back(
      State::Repeated{net::steady_timer(state_->io), period, std::move(act)}));
}

void Server::run() {
  state_->accept();
  while (!state_->io.stopped()) {
    try {
      state_->io.run();
    } catch (const std::exception&) {
      continue;  // what ran out of memory is lost, and nothing else
    }
  }
}

void Server::stop() {
  post([this] { state_->end(); });
}

void Server::post(std::function<void()> act) {
  net::post(state_->io, std::move(act));
}

ViewerCounts Server::counts() const {
  const Hub& hub = state_->hub;
  const Lobby& lobby = hub.lobby;
  return {.connections = hub.connections.size(),
          .clients = lobby.greeted().size(),
          .accepted = hub.accepted,
          .turned_away = hub.turned_away + lobby.turned_away(),
          .forbidden = hub.forbidden + lobby.wrong_tokens(),
          .refused = lobby.refused(),
          .closed_silent = hub.closed_silent};
}

}  // namespace palpate::viewer
