#include <fmt/core.h>

#include <stdexcept>

#include "viewer/room.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;

TEST(Lobby, HelloIsAnsweredByWelcome) {
  Room room;
  Client& client = room.enter(false);
  const auto messages = room.answers(client, kHello);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0]["type"], "welcome");
  EXPECT_EQ(messages[0]["version"], 1);
  EXPECT_EQ(messages[0]["devices"][0], json({{"name", "one"}, {"takeable", true}}));
  EXPECT_EQ(messages[0]["devices"][1]["takeable"], false);
  EXPECT_EQ(messages[0]["settings"][0]["key"], "k");
  EXPECT_EQ(messages[0]["settings"][0]["value"], 20.0);
  EXPECT_EQ(messages[0]["presets"], json::array({"soft"}));
  EXPECT_TRUE(client.greeted);
  EXPECT_EQ(client.points, 1000u);
}

TEST(Lobby, AWrongTokenClosesTheSocketAndTellsNothing) {
  Room room;
  Client& client = room.enter(false);
  EXPECT_TRUE(room.answers(client, R"({"type":"hello","token":"other","points":1})").empty());
  ASSERT_TRUE(client.closing);
  EXPECT_EQ(client.closing->code, 1008);
  EXPECT_FALSE(client.greeted);
  EXPECT_TRUE(room.answers(client, kHello).empty());
  EXPECT_EQ(room.lobby->wrong_tokens(), 1u);
}

TEST(Lobby, WhatComesBeforeHelloIsRefusedAndChangesNothing) {
  Room room;
  Client& client = room.enter(false);
  room.expect_refused(client, R"({"type":"set","key":"k","value":50})");
  room.expect_refused(client, R"({"type":"hand","device":0,"position":[1,2,3],"buttons":0})");
  room.expect_refused(client, R"({"type":"ping","id":1})");
  EXPECT_EQ(room.setting.value, SettingValue{20.0});
  EXPECT_EQ(room.hand, Eigen::Vector3d::Zero());
}

TEST(Lobby, WhoSaysNoHelloInTimeIsClosed) {
  Room room;
  Client& silent = room.enter(false);
  Client& greeted = room.enter();
  room.lobby->check(room.now + 5);
  EXPECT_FALSE(silent.closing);
  room.lobby->check(room.now + 5.1);
  ASSERT_TRUE(silent.closing);
  EXPECT_EQ(silent.closing->code, 1013) << "the page may be slow, and comes again";
  EXPECT_FALSE(greeted.closing);
}

TEST(Lobby, TheNinthClientIsRefusedWithWords) {
  Room room;
  for (int i = 0; i < 8; ++i) room.enter();
  Client& ninth = room.enter(false);
  room.expect_refused(ninth, kHello);
  ASSERT_TRUE(ninth.closing);
  EXPECT_EQ(ninth.closing->code, 1013);
  EXPECT_EQ(room.lobby->greeted().size(), 8u);
  room.lobby->leave(room.clients.front());
  room.enter();
  EXPECT_EQ(room.lobby->greeted().size(), 8u);
}

TEST(Lobby, ASettingThatChangesIsToldToAll) {
  Room room;
  Client& one = room.enter();
  Client& other = room.enter();
  const auto messages = room.answers(one, R"({"type":"set","key":"k","value":50})");
  const json expected{{"type", "settings"}, {"values", {{"k", 50.0}}}};
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], expected);
  EXPECT_EQ(Room::said(other), std::vector{expected});
  EXPECT_EQ(room.setting.value, SettingValue{50.0});
}

TEST(Lobby, ASettingOutOfRangeOrUnknownOrThatTheProgramRefusesStays) {
  Room room;
  Client& client = room.enter();
  for (const char* value : {"101", "-1", "true", "\"soft\"", "13"}) {
    room.expect_refused(client, fmt::format(R"({{"type":"set","key":"k","value":{}}})", value));
  }
  room.expect_refused(client, R"({"type":"set","key":"other","value":1})");
  room.expect_refused(client, R"({"type":"preset","name":"other"})");
  room.expect_refused(client, R"({"type":"record","on":true})");
  EXPECT_EQ(room.setting.value, SettingValue{20.0});
}

TEST(Lobby, PresetPauseResetPointsAndPingDoWhatTheySay) {
  Room room;
  Client& client = room.enter();
  EXPECT_EQ(room.answers(client, R"({"type":"preset","name":"soft"})")[0]["type"], "settings");
  EXPECT_EQ(room.preset, "soft");
  room.answers(client, R"({"type":"pause","on":true})");
  EXPECT_TRUE(room.paused);
  room.answers(client, R"({"type":"reset"})");
  EXPECT_EQ(room.resets, 1);
  room.answers(client, R"({"type":"points","points":77})");
  EXPECT_EQ(client.points, 77u);
  const auto pong = room.answers(client, R"({"type":"ping","id":12})");
  EXPECT_EQ(pong, std::vector({json({{"type", "pong"}, {"id", 12}})}));
}

TEST(Lobby, After20RefusalsIn10SecondsASocketIsClosed) {
  Room room;
  Client& patient = room.enter();
  for (int i = 0; i < 60; ++i) {
    room.now += 1;
    room.expect_refused(patient, "nonsense");
  }
  EXPECT_FALSE(patient.closing);
  Client& hasty = room.enter();
  for (int i = 0; i < 19; ++i) room.lobby->take_binary(hasty, room.now);
  EXPECT_FALSE(hasty.closing);
  room.lobby->take(hasty, "nonsense", room.now);
  ASSERT_TRUE(hasty.closing);
  EXPECT_EQ(hasty.closing->code, 1008);
  EXPECT_EQ(room.lobby->refused(), 80u);
}

TEST(Lobby, MoreThan250MessagesASecondAreRefused) {
  Room room;
  Client& client = room.enter();
  for (int i = 0; i < 249; ++i)
    room.lobby->take(client, R"({"type":"points","points":1})", room.now);
  EXPECT_TRUE(Room::said(client).empty());
  room.expect_refused(client, R"({"type":"points","points":2})");
  EXPECT_EQ(client.points, 1u);
  room.now += 1;
  EXPECT_TRUE(room.answers(client, R"({"type":"points","points":2})").empty());
  EXPECT_EQ(client.points, 2u);
}

TEST(Lobby, WhatAControlThrowsIsToldAndNothingElseHappens) {
  LobbyOptions options;
  options.token = "secret";
  options.welcome = [] { return Welcome{}; };
  options.controls.pause = [](bool) { throw std::runtime_error("no"); };
  Lobby lobby(std::move(options));
  Client client({}, 0);
  lobby.join(client);
  lobby.take(client, kHello, 0);
  Room::said(client);
  lobby.take(client, R"({"type":"pause","on":true})", 0);
  EXPECT_EQ(Room::said(client), std::vector({json({{"type", "refused"}, {"text", "no"}})}));
}

TEST(Lobby, ARecordThatIsOnIsToldToThoseWhoComeLater) {
  LobbyOptions options;
  options.token = "secret";
  options.welcome = [] { return Welcome{}; };
  options.controls.record = [](bool) { return std::string("steps.csv"); };
  Lobby lobby(std::move(options));
  Client one({}, 0);
  Client other({}, 0);
  lobby.join(one);
  lobby.take(one, kHello, 0);
  EXPECT_EQ(Room::said(one).size(), 1u);
  lobby.take(one, R"({"type":"record","on":true})", 0);
  const json on{{"type", "record"}, {"on", true}, {"file", "steps.csv"}};
  EXPECT_EQ(Room::said(one), std::vector{on});
  lobby.join(other);
  lobby.take(other, kHello, 0);
  const auto told = Room::said(other);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[1], on);
  lobby.end_record();
  const json off{{"type", "record"}, {"on", false}, {"file", "steps.csv"}};
  EXPECT_EQ(Room::said(one), std::vector{off}) << "it ended by itself";
  lobby.end_record();
  EXPECT_TRUE(Room::said(one).empty()) << "told once";
}

}  // namespace
}  // namespace palpate::viewer
