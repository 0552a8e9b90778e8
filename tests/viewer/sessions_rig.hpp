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
#include "viewer/client_sessions.hpp"

namespace palpate::viewer {

inline constexpr const char* kHello = R"({"type":"hello","token":"secret","points":1000})";

/// Sessions with one setting and two tools, the first of which a page may take.
struct SessionsRig {
  SessionsRig() {
    ClientSessionsOptions options;
    options.token = "secret";
    options.limits = limits;
    options.controls.settings = [this] { return std::vector{setting}; };
    options.controls.set = [this](const std::string&, const Setting::Value& value) {
      if (value == Setting::Value{13.0}) throw Error("not thirteen");
      setting.value = value;
    };
    options.controls.presets = {"wood"};
    options.controls.preset = [this](const std::string& name) { preset = name; };
    options.controls.pause = [this](bool on) { paused = on; };
    options.controls.reset = [this](std::optional<std::size_t> tool) { resets.push_back(tool); };
    options.controls.hand = [this](std::size_t, const TargetSource::Target& target,
                                   const std::optional<Eigen::Vector3d>& from) {
      hand = target.position;
      eye = from;
      pull = target.maximum_force;
    };
    options.controls.release = [this](std::size_t device) { released.push_back(device); };
    options.devices = {{"one", true}, {"two", false}};
    options.origin = {100, 0, 0};
    options.welcome = [] { return Welcome{}; };
    sessions.emplace(std::move(options));
  }

  Session& enter(bool hello = true) {
    Session& session = clients.emplace_back(limits, now);
    sessions->join(session);
    if (hello) {
      sessions->receive(session, kHello, now);
      said(session);
    }
    return session;
  }
  /// What was said to the client since the last time.
  static std::vector<nlohmann::json> said(Session& session) {
    std::vector<nlohmann::json> messages;
    while (const auto message = session.outbox.take())
      messages.push_back(nlohmann::json::parse(*message->bytes));
    return messages;
  }
  std::vector<nlohmann::json> answers(Session& session, const std::string& text) {
    sessions->receive(session, text, now);
    return said(session);
  }
  void expect_refused(Session& session, const std::string& text) {
    const auto answers_now = answers(session, text);
    ASSERT_EQ(answers_now.size(), 1u) << text;
    EXPECT_EQ(answers_now[0]["type"], "refused") << text;
    EXPECT_FALSE(answers_now[0]["text"].get<std::string>().empty()) << text;
  }

  double now = 50;
  ViewerOptions::Limits limits = {};
  Setting setting{.key = "k", .label = "Stiffness", .least = 0, .most = 100, .value = 20.0};
  std::string preset;
  bool paused = false;
  std::vector<std::optional<std::size_t>> resets;
  Eigen::Vector3d hand = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> eye = {};
  double pull = 0;
  std::vector<std::size_t> released;
  std::deque<Session> clients;
  std::optional<ClientSessions> sessions;
};

}  // namespace palpate::viewer
