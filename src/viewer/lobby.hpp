#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/viewer/viewer_controls.hpp"
#include "palpate/viewer/viewer_options.hpp"
#include "viewer/client.hpp"
#include "viewer/client_message.hpp"
#include "viewer/text_messages.hpp"

namespace palpate::viewer {

/// What a lobby is made of.
struct LobbyOptions {
  std::string token;
  ViewerLimits limits = {};
  ViewerControls controls = {};  ///< `pause` and `reset` are set
  std::vector<DeviceLabel> devices;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of places that pages tell
  std::function<Welcome()> welcome;  ///< devices, settings and presets are filled in
};

/// Where clients meet the program: takes what they say, answers, remembers who holds which tool.
/// Knows neither sockets nor clocks; one thread uses it.
class Lobby {
 public:
  explicit Lobby(LobbyOptions options) : options_(std::move(options)) {
    holders_.resize(options_.devices.size(), nullptr);
  }

  /// A client outlives its leaving.
  void join(Client& client) { clients_.push_back(&client); }
  /// Lets go of what the client held.
  void leave(Client& client);

  /// A message came at `now` (s).
  void take(Client& client, std::string_view text, double now);
  /// A binary message: a page sends none.
  void take_binary(Client& client, double now);
  /// Closes those who said no hello in time; lets go of tools whose holders have fallen silent.
  void check(double now);

  /// To all who said hello.
  void tell_all(Topic topic, Message message);
  void tell_settings();
  void tell(const Notice& notice);
  /// What was being recorded has ended by itself.
  void end_record();
  /// To one client, unless it was shown these very bytes last.
  static void show(Client& client, Topic topic, const SharedBytes& bytes);

  /// Is the device's tool held by a page?
  [[nodiscard]] bool taken(std::size_t device) const { return holders_[device] != nullptr; }
  [[nodiscard]] std::vector<Client*> greeted() const;
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] std::uint64_t wrong_tokens() const { return wrong_tokens_; }
  [[nodiscard]] std::uint64_t turned_away() const { return turned_away_; }

 private:
  void dispatch(Client& client, const ClientMessage& message);
  void act(Client& client, const Hello& hello);
  void act(Client& client, const Hand& hand);
  void act(Client& client, const Release& release);
  void act(Client& client, const Set& set);
  void act(Client& client, const Preset& preset);
  void act(Client& client, const Pause& pause);
  void act(Client& client, const Reset& reset);
  void act(Client& client, const Record& record);
  void act(Client& client, const Points& points);
  void act(Client& client, const Ping& ping);
  void act(Client& client, const Unreadable& unreadable);

  void welcome(Client& client);
  void answer(Client& client, std::string text);
  void refuse(Client& client, std::string_view text, double now);
  void close(Client& client, std::uint16_t code, std::string reason);
  void release(std::size_t device);
  void lose(std::size_t device, std::string_view why);
  [[nodiscard]] std::vector<Setting> settings() const;

  LobbyOptions options_;
  std::vector<Client*> clients_;
  std::vector<Client*> holders_;  // of each device's tool
  std::string recording_;         // the newest answer to `record`, while it is on
  std::uint64_t refused_ = 0;
  std::uint64_t wrong_tokens_ = 0;
  std::uint64_t turned_away_ = 0;
};

}  // namespace palpate::viewer
