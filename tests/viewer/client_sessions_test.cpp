#include <fmt/core.h>

#include <stdexcept>

#include "viewer/sessions_rig.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;

TEST(ClientSessions, HelloIsAnsweredByWelcome) {
  SessionsRig rig;
  Session& session = rig.enter(false);
  const auto messages = rig.answers(session, kHello);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0]["type"], "welcome");
  EXPECT_EQ(messages[0]["version"], 2);
  EXPECT_EQ(messages[0]["devices"][0], json({{"name", "one"}, {"takeable", true}, {"scale", 1.0}}));
  EXPECT_EQ(messages[0]["devices"][1]["takeable"], false);
  EXPECT_EQ(messages[0]["settings"][0]["key"], "k");
  EXPECT_EQ(messages[0]["settings"][0]["value"], 20.0);
  EXPECT_EQ(messages[0]["presets"], json::array({"wood"}));
  EXPECT_TRUE(session.greeted);
  EXPECT_EQ(session.points, 1000u);
}

TEST(ClientSessions, AWrongTokenClosesTheSocketAndTellsNothing) {
  SessionsRig rig;
  Session& session = rig.enter(false);
  EXPECT_TRUE(rig.answers(session, R"({"type":"hello","token":"other","points":1})").empty());
  ASSERT_TRUE(session.closing);
  EXPECT_EQ(session.closing->code, 1008);
  EXPECT_FALSE(session.greeted);
  EXPECT_TRUE(rig.answers(session, kHello).empty());
  EXPECT_EQ(rig.sessions->counts().forbidden, 1u);
}

TEST(ClientSessions, WhatComesBeforeHelloIsRefusedAndChangesNothing) {
  SessionsRig rig;
  Session& session = rig.enter(false);
  rig.expect_refused(session, R"({"type":"set","key":"k","value":50})");
  rig.expect_refused(session, R"({"type":"hand","device":0,"position":[1,2,3],"buttons":0})");
  rig.expect_refused(session, R"({"type":"ping","id":1})");
  EXPECT_EQ(rig.setting.value, Setting::Value{20.0});
  EXPECT_EQ(rig.hand, Eigen::Vector3d::Zero());
}

TEST(ClientSessions, WhoSaysNoHelloInTimeIsClosed) {
  SessionsRig rig;
  Session& silent = rig.enter(false);
  Session& greeted = rig.enter();
  rig.sessions->check(rig.now + 5);
  EXPECT_FALSE(silent.closing);
  rig.sessions->check(rig.now + 5.1);
  ASSERT_TRUE(silent.closing);
  EXPECT_EQ(silent.closing->code, 1013) << "the page may be slow, and comes again";
  EXPECT_FALSE(greeted.closing);
}

TEST(ClientSessions, TheNinthClientIsRefusedWithWords) {
  SessionsRig rig;
  for (int i = 0; i < 8; ++i) rig.enter();
  Session& ninth = rig.enter(false);
  rig.expect_refused(ninth, kHello);
  ASSERT_TRUE(ninth.closing);
  EXPECT_EQ(ninth.closing->code, 1013);
  EXPECT_EQ(rig.sessions->greeted().size(), 8u);
  rig.sessions->leave(rig.clients.front());
  rig.enter();
  EXPECT_EQ(rig.sessions->greeted().size(), 8u);
}

TEST(ClientSessions, ASettingThatChangesIsToldToAll) {
  SessionsRig rig;
  Session& one = rig.enter();
  Session& other = rig.enter();
  const auto messages = rig.answers(one, R"({"type":"set","key":"k","value":50})");
  const json expected{{"type", "settings"}, {"values", {{"k", 50.0}}}};
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], expected);
  EXPECT_EQ(SessionsRig::said(other), std::vector{expected});
  EXPECT_EQ(rig.setting.value, Setting::Value{50.0});
}

TEST(ClientSessions, ASettingOutOfRangeOrUnknownOrThatTheProgramRefusesStays) {
  SessionsRig rig;
  Session& session = rig.enter();
  for (const char* value : {"101", "-1", "true", "\"soft\"", "13"}) {
    rig.expect_refused(session, fmt::format(R"({{"type":"set","key":"k","value":{}}})", value));
  }
  rig.expect_refused(session, R"({"type":"set","key":"other","value":1})");
  rig.expect_refused(session, R"({"type":"preset","name":"other"})");
  rig.expect_refused(session, R"({"type":"record","on":true})");
  EXPECT_EQ(rig.setting.value, Setting::Value{20.0});
}

TEST(ClientSessions, PresetPauseResetPointsAndPingDoWhatTheySay) {
  SessionsRig rig;
  Session& session = rig.enter();
  EXPECT_EQ(rig.answers(session, R"({"type":"preset","name":"wood"})")[0]["type"], "settings");
  EXPECT_EQ(rig.preset, "wood");
  rig.answers(session, R"({"type":"pause","on":true})");
  EXPECT_TRUE(rig.paused);
  rig.answers(session, R"({"type":"reset"})");
  rig.answers(session, R"({"type":"reset","device":0})");
  EXPECT_EQ(rig.resets, (std::vector<std::optional<std::size_t>>{std::nullopt, 0}));
  rig.expect_refused(session, R"({"type":"reset","device":9})");
  rig.answers(session, R"({"type":"points","points":77})");
  EXPECT_EQ(session.points, 77u);
  const auto pong = rig.answers(session, R"({"type":"ping","id":12})");
  EXPECT_EQ(pong, std::vector({json({{"type", "pong"}, {"id", 12}})}));
}

TEST(ClientSessions, After20RefusalsIn10SecondsASocketIsClosed) {
  SessionsRig rig;
  Session& patient = rig.enter();
  for (int i = 0; i < 60; ++i) {
    rig.now += 1;
    rig.expect_refused(patient, "nonsense");
  }
  EXPECT_FALSE(patient.closing);
  Session& hasty = rig.enter();
  for (int i = 0; i < 19; ++i) rig.sessions->refuse(hasty, "binary", rig.now);
  EXPECT_FALSE(hasty.closing);
  rig.sessions->receive(hasty, "nonsense", rig.now);
  ASSERT_TRUE(hasty.closing);
  EXPECT_EQ(hasty.closing->code, 1008);
  EXPECT_EQ(rig.sessions->counts().refused, 80u);
}

TEST(ClientSessions, MoreThan250MessagesASecondAreRefused) {
  SessionsRig rig;
  Session& session = rig.enter();
  for (int i = 0; i < 249; ++i)
    rig.sessions->receive(session, R"({"type":"points","points":1})", rig.now);
  EXPECT_TRUE(SessionsRig::said(session).empty());
  rig.expect_refused(session, R"({"type":"points","points":2})");
  EXPECT_EQ(session.points, 1u);
  rig.now += 1;
  EXPECT_TRUE(rig.answers(session, R"({"type":"points","points":2})").empty());
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
  SessionsRig::said(session);
  sessions.receive(session, R"({"type":"pause","on":true})", 0);
  EXPECT_EQ(SessionsRig::said(session), std::vector({json({{"type", "refused"}, {"text", "no"}})}));
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
  EXPECT_EQ(SessionsRig::said(one).size(), 1u);
  sessions.receive(one, R"({"type":"record","on":true})", 0);
  const json on{{"type", "record"}, {"on", true}, {"file", "steps.csv"}};
  EXPECT_EQ(SessionsRig::said(one), std::vector{on});
  sessions.join(other);
  sessions.receive(other, kHello, 0);
  const auto told = SessionsRig::said(other);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[1], on);
  sessions.end_record();
  const json off{{"type", "record"}, {"on", false}, {"file", "steps.csv"}};
  EXPECT_EQ(SessionsRig::said(one), std::vector{off}) << "it ended by itself";
  sessions.end_record();
  EXPECT_TRUE(SessionsRig::said(one).empty()) << "told once";
}

}  // namespace
}  // namespace palpate::viewer
