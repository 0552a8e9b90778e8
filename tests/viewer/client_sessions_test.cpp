#include <fmt/core.h>

#include <stdexcept>

#include "viewer/room.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;

TEST(ClientSessions, HelloIsAnsweredByWelcome) {
  Room room;
  Session& session = room.enter(false);
  const auto messages = room.answers(session, kHello);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0]["type"], "welcome");
  EXPECT_EQ(messages[0]["version"], 1);
  EXPECT_EQ(messages[0]["devices"][0], json({{"name", "one"}, {"takeable", true}}));
  EXPECT_EQ(messages[0]["devices"][1]["takeable"], false);
  EXPECT_EQ(messages[0]["settings"][0]["key"], "k");
  EXPECT_EQ(messages[0]["settings"][0]["value"], 20.0);
  EXPECT_EQ(messages[0]["presets"], json::array({"soft"}));
  EXPECT_TRUE(session.greeted);
  EXPECT_EQ(session.points, 1000u);
}

TEST(ClientSessions, AWrongTokenClosesTheSocketAndTellsNothing) {
  Room room;
  Session& session = room.enter(false);
  EXPECT_TRUE(room.answers(session, R"({"type":"hello","token":"other","points":1})").empty());
  ASSERT_TRUE(session.closing);
  EXPECT_EQ(session.closing->code, 1008);
  EXPECT_FALSE(session.greeted);
  EXPECT_TRUE(room.answers(session, kHello).empty());
  EXPECT_EQ(room.sessions->wrong_tokens(), 1u);
}

TEST(ClientSessions, WhatComesBeforeHelloIsRefusedAndChangesNothing) {
  Room room;
  Session& session = room.enter(false);
  room.expect_refused(session, R"({"type":"set","key":"k","value":50})");
  room.expect_refused(session, R"({"type":"hand","device":0,"position":[1,2,3],"buttons":0})");
  room.expect_refused(session, R"({"type":"ping","id":1})");
  EXPECT_EQ(room.setting.value, SettingValue{20.0});
  EXPECT_EQ(room.hand, Eigen::Vector3d::Zero());
}

TEST(ClientSessions, WhoSaysNoHelloInTimeIsClosed) {
  Room room;
  Session& silent = room.enter(false);
  Session& greeted = room.enter();
  room.sessions->check(room.now + 5);
  EXPECT_FALSE(silent.closing);
  room.sessions->check(room.now + 5.1);
  ASSERT_TRUE(silent.closing);
  EXPECT_EQ(silent.closing->code, 1013) << "the page may be slow, and comes again";
  EXPECT_FALSE(greeted.closing);
}

TEST(ClientSessions, TheNinthClientIsRefusedWithWords) {
  Room room;
  for (int i = 0; i < 8; ++i) room.enter();
  Session& ninth = room.enter(false);
  room.expect_refused(ninth, kHello);
  ASSERT_TRUE(ninth.closing);
  EXPECT_EQ(ninth.closing->code, 1013);
  EXPECT_EQ(room.sessions->greeted().size(), 8u);
  room.sessions->leave(room.clients.front());
  room.enter();
  EXPECT_EQ(room.sessions->greeted().size(), 8u);
}

TEST(ClientSessions, ASettingThatChangesIsToldToAll) {
  Room room;
  Session& one = room.enter();
  Session& other = room.enter();
  const auto messages = room.answers(one, R"({"type":"set","key":"k","value":50})");
  const json expected{{"type", "settings"}, {"values", {{"k", 50.0}}}};
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], expected);
  EXPECT_EQ(Room::said(other), std::vector{expected});
  EXPECT_EQ(room.setting.value, SettingValue{50.0});
}

TEST(ClientSessions, ASettingOutOfRangeOrUnknownOrThatTheProgramRefusesStays) {
  Room room;
  Session& session = room.enter();
  for (const char* value : {"101", "-1", "true", "\"soft\"", "13"}) {
    room.expect_refused(session, fmt::format(R"({{"type":"set","key":"k","value":{}}})", value));
  }
  room.expect_refused(session, R"({"type":"set","key":"other","value":1})");
  room.expect_refused(session, R"({"type":"preset","name":"other"})");
  room.expect_refused(session, R"({"type":"record","on":true})");
  EXPECT_EQ(room.setting.value, SettingValue{20.0});
}

TEST(ClientSessions, PresetPauseResetPointsAndPingDoWhatTheySay) {
  Room room;
  Session& session = room.enter();
  EXPECT_EQ(room.answers(session, R"({"type":"preset","name":"soft"})")[0]["type"], "settings");
  EXPECT_EQ(room.preset, "soft");
  room.answers(session, R"({"type":"pause","on":true})");
  EXPECT_TRUE(room.paused);
  room.answers(session, R"({"type":"reset"})");
  EXPECT_EQ(room.resets, 1);
  room.answers(session, R"({"type":"points","points":77})");
  EXPECT_EQ(session.points, 77u);
  const auto pong = room.answers(session, R"({"type":"ping","id":12})");
  EXPECT_EQ(pong, std::vector({json({{"type", "pong"}, {"id", 12}})}));
}

TEST(ClientSessions, After20RefusalsIn10SecondsASocketIsClosed) {
  Room room;
  Session& patient = room.enter();
  for (int i = 0; i < 60; ++i) {
    room.now += 1;
    room.expect_refused(patient, "nonsense");
  }
  EXPECT_FALSE(patient.closing);
  Session& hasty = room.enter();
  for (int i = 0; i < 19; ++i) room.sessions->receive_binary(hasty, room.now);
  EXPECT_FALSE(hasty.closing);
  room.sessions->receive(hasty, "nonsense", room.now);
  ASSERT_TRUE(hasty.closing);
  EXPECT_EQ(hasty.closing->code, 1008);
  EXPECT_EQ(room.sessions->refused(), 80u);
}

TEST(ClientSessions, MoreThan250MessagesASecondAreRefused) {
  Room room;
  Session& session = room.enter();
  for (int i = 0; i < 249; ++i)
    room.sessions->receive(session, R"({"type":"points","points":1})", room.now);
  EXPECT_TRUE(Room::said(session).empty());
  room.expect_refused(session, R"({"type":"points","points":2})");
  EXPECT_EQ(session.points, 1u);
  room.now += 1;
  EXPECT_TRUE(room.answers(session, R"({"type":"points","points":2})").empty());
  EXPECT_EQ(session.points, 2u);
}

TEST(ClientSessions, WhatAControlThrowsIsToldAndNothingElseHappens) {
  ClientSessionsOptions options;
  options.token = "secret";
  options.welcome = [] { return Welcome{}; };
  options.controls.pause = [](bool) { throw std::runtime_error("no"); };
  ClientSessions sessions(std::move(options));
  Session session({}, 0);
  sessions.join(session);
  sessions.receive(session, kHello, 0);
  Room::said(session);
  sessions.receive(session, R"({"type":"pause","on":true})", 0);
  EXPECT_EQ(Room::said(session), std::vector({json({{"type", "refused"}, {"text", "no"}})}));
}

TEST(ClientSessions, ARecordThatIsOnIsToldToThoseWhoComeLater) {
  ClientSessionsOptions options;
  options.token = "secret";
  options.welcome = [] { return Welcome{}; };
  options.controls.record = [](bool) { return std::string("steps.csv"); };
  ClientSessions sessions(std::move(options));
  Session one({}, 0);
  Session other({}, 0);
  sessions.join(one);
  sessions.receive(one, kHello, 0);
  EXPECT_EQ(Room::said(one).size(), 1u);
  sessions.receive(one, R"({"type":"record","on":true})", 0);
  const json on{{"type", "record"}, {"on", true}, {"file", "steps.csv"}};
  EXPECT_EQ(Room::said(one), std::vector{on});
  sessions.join(other);
  sessions.receive(other, kHello, 0);
  const auto told = Room::said(other);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[1], on);
  sessions.end_record();
  const json off{{"type", "record"}, {"on", false}, {"file", "steps.csv"}};
  EXPECT_EQ(Room::said(one), std::vector{off}) << "it ended by itself";
  sessions.end_record();
  EXPECT_TRUE(Room::said(one).empty()) << "told once";
}

}  // namespace
}  // namespace palpate::viewer
