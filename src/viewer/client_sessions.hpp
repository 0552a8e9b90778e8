#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/messages.hpp"
#include "viewer/session.hpp"

namespace palpate::viewer {

/// What the program lets pages do.
struct ClientSessionsOptions {
  std::string token;
  ViewerOptions::Limits limits = {};
  ViewerControls controls = {};  ///< `pause` and `reset` are set
  std::vector<DeviceLabel> devices;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of places that pages tell
  std::function<Welcome()> welcome;  ///< devices, settings and presets are filled in
};

/// All clients of the program: reads what they say, answers, remembers who holds which tool.
/// Knows neither sockets nor clocks; one thread uses it.
class ClientSessions {
 public:
  explicit ClientSessions(ClientSessionsOptions options) : options_(std::move(options)) {
    holders_.resize(options_.devices.size(), nullptr);
  }

  /// A client outlives its leaving.
  void join(Session& session) { sessions_.push_back(&session); }
  /// Lets go of what the client held.
  void leave(Session& session);

  /// A message came at `now` (s).
  void receive(Session& session, std::string_view text, double now);
  /// A binary message: a page sends none.
  void receive_binary(Session& session, double now);
  /// Closes those who said no hello in time; lets go of tools whose holders have fallen silent.
  void check(double now);

  /// To all who said hello.
  void send_to_all(Topic topic, Message message);
  void send_settings();
  void send(const Notice& notice);
  /// What was being recorded has ended by itself.
  void end_record();
  /// To one client, unless it was shown these very bytes last.
  static void show(Session& session, Topic topic, const SharedBytes& bytes);

  /// Is the device's tool held by a page?
  [[nodiscard]] bool taken(std::size_t device) const { return holders_[device] != nullptr; }
  [[nodiscard]] std::vector<Session*> greeted() const;
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] std::uint64_t wrong_tokens() const { return wrong_tokens_; }
  [[nodiscard]] std::uint64_t turned_away() const { return turned_away_; }

 private:
  void act(Session& session, const Hello& hello);
  void act(Session& session, const Hand& hand);
  void act(Session& session, const Release& release);
  void act(Session& session, const Set& set);
  void act(Session& session, const Preset& preset);
  void act(Session& session, const Pause& pause);
  void act(Session& session, const Reset& reset);
  void act(Session& session, const Record& record);
  static void act(Session& session, const Points& points) { session.points = points.points; }
  void act(Session& session, const Ping& ping) { answer(session, pong_text(ping.id)); }
  static void act(Session&, const Unreadable& unreadable) { throw Error(unreadable.text); }

  void welcome(Session& session);
  void answer(Session& session, std::string text);
  void refuse(Session& session, std::string_view text, double now);
  void close(Session& session, std::uint16_t code, std::string reason);
  void release(std::size_t device);
  void lose(std::size_t device, std::string_view why);
  [[nodiscard]] std::vector<Setting> settings() const;

  ClientSessionsOptions options_;
  std::vector<Session*> sessions_;
  std::vector<Session*> holders_;  // of each device's tool
  std::string recording_;          // the newest answer to `record`, while it is on
  std::uint64_t refused_ = 0;
  std::uint64_t wrong_tokens_ = 0;
  std::uint64_t turned_away_ = 0;
};

}  // namespace palpate::viewer
