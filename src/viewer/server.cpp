// Listens for browsers and closes their connections at the end.
#include "viewer/server.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cerrno>
#include <deque>
#include <exception>
#include <utility>

#include "palpate/base/error.hpp"
#include "viewer/connections.hpp"

namespace palpate::viewer {
namespace {

constexpr int kPortsTried = 10;       // ports from the first on (judgement)
constexpr double kCheck = 0.1;        // s between checks of waiting connections (judgement)
constexpr double kAcceptAgain = 0.2;  // s, after the system gave no socket (judgement)
// s between checks at the end whether all have closed (judgement)
constexpr double kLastLook = 0.01;
constexpr int kLastLooks = 20;  // such checks (judgement)

net::ip::address address_of(const std::string& text) {
  ErrorCode error;
  const auto address = net::ip::make_address(text, error);
  if (!error) return address;
  throw Error(fmt::format(
      "viewer: '{}' is not an IP address; give one like 127.0.0.1, ::1 or 0.0.0.0 (all interfaces)",
      text));
}

int duplicate(int socket) {
  const int copy = ::fcntl(socket, F_DUPFD_CLOEXEC, 0);
  if (copy >= 0) return copy;
  throw Error(fmt::format("viewer: cannot keep its port: {}; close other files of this program",
                          ErrorCode(errno, boost::system::system_category()).message()));
}

// A program that this one starts (a browser) has no part in its sockets.
template <class Socket>
void keep_to_ourselves(Socket& socket) {
  ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
}

ErrorCode listen(Tcp::acceptor& acceptor, const Tcp::endpoint& endpoint) {
  ErrorCode error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) keep_to_ourselves(acceptor);
  if (!error) acceptor.set_option(net::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  ErrorCode ignored;
  if (error) acceptor.close(ignored);
  return error;
}

Listening name_of(const Tcp::acceptor& acceptor) {
  const Tcp::endpoint here = acceptor.local_endpoint();
  return {here.address().to_string(), here.port(), here.address().is_unspecified()};
}

// ", such as 8421": the next port that is free; empty: none near it is.
std::string free_port_behind(Tcp::acceptor& acceptor, const net::ip::address& address, int first) {
  for (int port = first + 1; port <= std::min(first + kPortsTried, 65535); ++port) {
    if (listen(acceptor, {address, static_cast<std::uint16_t>(port)})) continue;
    acceptor.close();
    return fmt::format(", such as {}", port);
  }
  return {};
}

Listening listen(Tcp::acceptor& acceptor, const ViewerOptions& options) {
  const net::ip::address address = address_of(options.address);
  const int tries = options.port ? 1 : kPortsTried;
  const std::uint16_t first = options.port.value_or(ViewerOptions::kFirstPort);
  ErrorCode error;
  for (int i = 0; i < tries; ++i) {
    error = listen(acceptor, {address, static_cast<std::uint16_t>(first + i)});
    if (error) continue;
    return name_of(acceptor);
  }
  const std::string ports = tries == 1 ? fmt::format("port {}", first)
                                       : fmt::format("any port {}-{}", first, first + tries - 1);
  const bool taken = tries == 1 && error == net::error::address_in_use;
  throw Error(fmt::format("viewer: cannot listen on {} at {}: {}; give another address or port{}",
                          ports, options.address, error.message(),
                          taken ? free_port_behind(acceptor, address, first) : ""));
}

}  // namespace

}  // namespace palpate::viewer

namespace palpate {

class ListeningPort {
 public:
  ListeningPort(int socket, viewer::Tcp protocol)
      : protocol_(protocol), socket_(viewer::duplicate(socket)) {}
  ~ListeningPort() { ::close(socket_); }
  ListeningPort(const ListeningPort&) = delete;
  ListeningPort& operator=(const ListeningPort&) = delete;

  void give_to(viewer::Tcp::acceptor& acceptor) const {
    acceptor.assign(protocol_, viewer::duplicate(socket_));
  }

 private:
  viewer::Tcp protocol_;
  int socket_;
};

}  // namespace palpate

namespace palpate::viewer {

struct Server::State {
  struct Repeated {
    net::steady_timer timer;
    double period;
    std::function<void()> act;
  };

  State(const ViewerOptions& options, ClientSessions& sessions)
      : acceptor(io), again(io), context{options.limits, begin(acceptor, options), sessions} {}

  // Goes on with the port of a viewer before, or opens one.
  static Listening begin(Tcp::acceptor& acceptor, const ViewerOptions& options) {
    if (!options.listening) return listen(acceptor, options);
    options.listening->give_to(acceptor);
    return name_of(acceptor);
  }

  void accept();
  void take(Tcp::socket socket);
  void repeat(Repeated& task);
  void check();
  void end();
  void wait_for_last_words(int looks);

  net::io_context io{1};
  Tcp::acceptor acceptor;
  net::steady_timer again;
  ServerContext context;
  std::deque<Repeated> repeated;
  bool ending = false;
};

void Server::State::accept() {
  acceptor.async_accept([this](const ErrorCode& error, Tcp::socket socket) {
    if (ending) return;
    if (!error) {
      accept();  // first: what goes wrong with one socket keeps no other out
      take(std::move(socket));
      return;
    }
    again.expires_after(nanoseconds(kAcceptAgain));
    again.async_wait([this](const ErrorCode&) {
      if (!ending) accept();
    });
  });
}

void Server::State::take(Tcp::socket socket) {
  keep_to_ourselves(socket);
  ++context.accepted;
  if (context.connections.size() >= context.limits.connections) {
    ++context.turned_away;
    return;  // closes it
  }
  serve(context, std::move(socket));
}

// A time that passed is left out: no burst after a pause.
void Server::State::repeat(Repeated& task) {
  task.timer.expires_after(nanoseconds(task.period));
  task.timer.async_wait([this, &task](const ErrorCode& error) {
    if (error || ending) return;
    repeat(task);
    task.act();
  });
}

void Server::State::check() {
  const double now = ServerContext::now();
  context.sessions.check(now);
  // Closed connections leave the set later, when their operations end.
  for (Connection* connection : context.connections) connection->check(now);
}

void Server::State::end() {
  ending = true;
  ErrorCode ignored;
  acceptor.close(ignored);
  for (Repeated& one : repeated) one.timer.cancel();
  for (Connection* connection : context.connections) connection->end();
  wait_for_last_words(kLastLooks);
}

void Server::State::wait_for_last_words(int looks) {
  if (context.connections.empty()) return;
  if (looks == 0) {
    for (Connection* connection : context.connections) connection->abort();
    return;
  }
  again.expires_after(nanoseconds(kLastLook));
  again.async_wait([this, looks](const ErrorCode&) { wait_for_last_words(looks - 1); });
}

Server::Server(const ViewerOptions& options, ClientSessions& sessions)
    : state_(std::make_unique<State>(options, sessions)) {
  every(kCheck, [this] { state_->check(); });
}

Server::~Server() = default;

std::shared_ptr<const ListeningPort> Server::keep_listening() const {
  Tcp::acceptor& acceptor = state_->acceptor;
  return std::make_shared<ListeningPort>(acceptor.native_handle(),
                                         acceptor.local_endpoint().protocol());
}

const Listening& Server::listening() const {
  return state_->context.listening;
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

void Server::restarts(std::string why) {
  state_->context.end = {close_code::kRestart, std::move(why)};
}

Viewer::Counts Server::counts() const {
  const ServerContext& context = state_->context;
  Viewer::Counts counts = context.sessions.counts();
  counts.connections = context.connections.size();
  counts.clients = context.sessions.greeted().size();
  counts.accepted = context.accepted;
  counts.turned_away += context.turned_away;
  counts.forbidden += context.forbidden;
  counts.closed_silent = context.closed_silent;
  return counts;
}

}  // namespace palpate::viewer
