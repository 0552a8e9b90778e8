#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palpate/base/error.hpp"
#include "viewer/lobby.hpp"

namespace palpate::viewer {

inline constexpr const char* kHello = R"({"type":"hello","token":"secret","points":1000})";

/// A lobby with one setting and two tools, the first of which a page may take.
struct Room {
  Room() {
    LobbyOptions options;
    options.token = "secret";
    options.limits = limits;
    options.controls.settings = [this] { return std::vector{setting}; };
    options.controls.set = [this](const std::string&, const SettingValue& value) {
      if (value == SettingValue{13.0}) throw Error("not thirteen");
      setting.value = value;
    };
    options.controls.presets = {"soft"};
    options.controls.preset = [this](const std::string& name) { preset = name; };
    options.controls.pause = [this](bool on) { paused = on; };
    options.controls.reset = [this] { ++resets; };
    options.controls.hand = [this](std::size_t, const Eigen::Vector3d& place, std::uint32_t) {
      hand = place;
    };
    options.controls.release = [this](std::size_t device) { released.push_back(device); };
    options.devices = {{"one", true}, {"two", false}};
    options.origin = {100, 0, 0};
    options.welcome = [] { return Welcome{}; };
    lobby.emplace(std::move(options));
  }

  Client& enter(bool hello = true) {
    Client& client = clients.emplace_back(limits, now);
    lobby->join(client);
    if (hello) {
      lobby->take(client, kHello, now);
      said(client);
    }
    return client;
  }
  /// What was said to the client since the last time.
  static std::vector<nlohmann::json> said(Client& client) {
    std::vector<nlohmann::json> messages;
    while (const auto message = client.outbox.take())
      messages.push_back(nlohmann::json::parse(*message->bytes));
    return messages;
  }
  std::vector<nlohmann::json> answers(Client& client, const std::string& text) {
    lobby->take(client, text, now);
    return said(client);
  }
  void expect_refused(Client& client, const std::string& text) {
    const auto answers_now = answers(client, text);
    ASSERT_EQ(answers_now.size(), 1u) << text;
    EXPECT_EQ(answers_now[0]["type"], "refused") << text;
    EXPECT_FALSE(answers_now[0]["text"].get<std::string>().empty()) << text;
  }

  double now = 50;
  ViewerLimits limits = {};
  Setting setting{.key = "k", .label = "Stiffness", .least = 0, .most = 100, .value = 20.0};
  std::string preset;
  bool paused = false;
  int resets = 0;
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();
  std::vector<std::size_t> released;
  std::deque<Client> clients;
  std::optional<Lobby> lobby;
};

}  // namespace palpate::viewer
