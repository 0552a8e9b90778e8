#pragma once

#include <Eigen/Core>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace palpate::test {

/// Stands for Haply's Inverse Service, on a thread of its own: speaks first, answers each message
/// with a frame, and goes wrong when it is told to. Its device goes 1 um to the right with every
/// command; its places are counted from its base until a preset asks for the middle of its reach.
class FakeHaplyService {
 public:
  enum class Fault {
    none,
    closes,
    garbage,
    not_a_number,
    null,
    far,
    silent,
    late,
    gone,
    reset,
    no_rotation
  };

  FakeHaplyService() : thread_([this] { serve(); }) {}
  /// Whoever is connected has to leave first.
  ~FakeHaplyService() {
    stopping_ = true;
    Tcp::socket last(io_);
    boost::system::error_code ignored;
    last.connect(acceptor_.local_endpoint(), ignored);
    thread_.join();
  }
  FakeHaplyService(const FakeHaplyService&) = delete;
  FakeHaplyService& operator=(const FakeHaplyService&) = delete;

  [[nodiscard]] std::string url() const {
    return "ws://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port());
  }
  void set(Fault fault) { fault_ = fault; }
  [[nodiscard]] int commands() const { return commands_; }
  [[nodiscard]] std::vector<Eigen::Vector3d> forces() const {
    const std::lock_guard lock(mutex_);
    return forces_;
  }
  [[nodiscard]] int connections() const { return connections_; }

 private:
  using Tcp = boost::asio::ip::tcp;
  using Json = nlohmann::json;
  using Socket = boost::beast::websocket::stream<Tcp::socket>;

  void serve() {
    while (true) {
      Tcp::socket accepted(io_);
      boost::system::error_code failed;
      acceptor_.accept(accepted, failed);
      if (stopping_) return;
      Socket socket(std::move(accepted));
      socket.next_layer().set_option(Tcp::no_delay(true));
      socket.accept(failed);
      if (!failed) talk(socket);
    }
  }

  void talk(Socket& socket) {
    ++connections_;
    centred_ = false;
    boost::system::error_code failed;
    say(socket, frame(fault_), failed);
    while (!failed) {
      boost::beast::flat_buffer buffer;
      socket.read(buffer, failed);
      if (failed) return;
      take(boost::beast::buffers_to_string(buffer.data()));
      const Fault fault = fault_;
      if (fault == Fault::silent) continue;
      if (fault == Fault::late) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (fault == Fault::closes) {
        socket.close(boost::beast::websocket::close_code::going_away, failed);
        return;
      }
      say(socket, frame(fault), failed);
    }
  }
  static void say(Socket& socket, const std::string& text, boost::system::error_code& failed) {
    socket.text(true);
    socket.write(boost::asio::buffer(text), failed);
  }

  void take(const std::string& text) {
    const Json message = Json::parse(text);
    if (!message.contains("inverse3")) return;  // a greeting
    const Json& device = message["inverse3"][0];
    if (device.contains("configure")) {
      centred_ = device["configure"]["preset"]["preset"] == "arm_front_centered";
      return;
    }
    const Json& command = device["commands"]["set_cursor_force"];
    const Json& force = command["vector"];
    if (command["values"] != force) return;  // as services of 3.1 call it
    const std::lock_guard lock(mutex_);
    forces_.emplace_back(force["x"].get<double>(), force["y"].get<double>(),
                         force["z"].get<double>());
    ++commands_;
  }

  [[nodiscard]] std::string frame(Fault fault) const {
    if (fault == Fault::garbage) return R"({"inverse3":[{"device_id")";
    const bool calibrated = fault != Fault::reset;
    Json device = {
        {"device_id", fault == Fault::gone ? "0000" : "04EA"},
        {"state",
         {{"cursor_position",
           {{"x", 1e-6 * commands_}, {"y", -0.036}, {"z", centred_ ? -0.061 : 0.09}}},
          {"cursor_velocity", {{"x", 0.1}, {"y", 0.2}, {"z", -0.3}}},
          {"angular_position", {{"a0", -30.9}, {"a1", 53.8}, {"a2", -6.6}}},
          {"body_orientation", {{"w", 1}, {"x", 0}, {"y", 0}, {"z", 0}}},
          {"current_cursor_force", {{"x", 0}, {"y", 0}, {"z", 0}}},
          {"control_mode", "idle"}}},
        {"status", {{"calibrated", calibrated}, {"in_use", false}, {"power_supply", true}}}};
    Json& place = device["state"]["cursor_position"];
    if (fault == Fault::null) place["y"] = nullptr;
    if (fault == Fault::far) place["y"] = 1e9;
    const double w = fault == Fault::no_rotation ? 0.9 : 0.6;
    const Json grip = {{"device_id", "61576"},
                       {"state",
                        {{"orientation", {{"w", w}, {"x", 0}, {"y", -0.8}, {"z", 0}}},
                         {"buttons", {{"a", true}, {"b", false}, {"c", true}}}}}};
    std::string text = Json{
        {"inverse3", {{{"device_id", "0001"}}, device}},
        {"wireless_verse_grip",
         {grip}}}.dump();
    if (fault == Fault::not_a_number) text.replace(text.find("-0.036"), 6, "NaN");
    return text;
  }

  boost::asio::io_context io_{1};
  Tcp::acceptor acceptor_{io_, Tcp::endpoint(boost::asio::ip::make_address("127.0.0.1"), 0)};
  std::atomic<bool> stopping_ = false;
  std::atomic<Fault> fault_ = Fault::none;
  std::atomic<int> commands_ = 0;
  std::atomic<int> connections_ = 0;
  bool centred_ = false;
  mutable std::mutex mutex_;
  std::vector<Eigen::Vector3d> forces_;  // as they were commanded
  std::thread thread_;                   // last: it uses all of the above
};

}  // namespace palpate::test
