// A recording shown in place of a run: what pages say and are told (docs/viewer_protocol.md).
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "servo/step_trace.hpp"
#include "viewer/bytes.hpp"
#include "viewer/client_sessions.hpp"
#include "viewer/reports.hpp"
#include "viewer/sessions_rig.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;
using test::f32;
using test::u32;
using test::u8;

// A recording of 10 s and of one hand.
struct Recorded {
  Recorded() {
    TimeLine line;
    line.length = 10;
    line.moment = [this] { return moment; };
    line.seek = [this](double time) { moment.time = time; };
    line.play = [this](bool on, double speed) {
      moment.playing = on;
      moment.speed = speed;
    };
    line.envelope = [] { return std::vector<float>{0, 1.5F}; };
    line.past = [](std::size_t) {
      return std::vector<TimeLine::Force>{{7, {1, 2, 3}}, {7.5, {4, 5, 6}}};
    };
    controls.time_line = line;
  }

  TimeLine::Moment moment;
  ViewerControls controls;
};

// Its sessions, and a page.
struct Pages {
  Pages() {
    ClientSessionsOptions options;
    options.token = "secret";
    options.controls = recorded.controls;
    options.devices = {{"one", false}};
    options.welcome = [] { return Welcome{}; };
    sessions.emplace(std::move(options));
    sessions->join(page);
    sessions->receive(page, kHello, 0);
  }
  // What was said to it since the last time: texts, and the past.
  std::vector<json> said() {
    std::vector<json> texts;
    while (const auto message = page.outbox.take()) {
      if (message->text) {
        texts.push_back(json::parse(*message->bytes));
      } else {
        past = *message->bytes;
      }
    }
    return texts;
  }
  std::vector<json> answers(const std::string& text) {
    sessions->receive(page, text, 0);
    sessions->send_moment();
    return said();
  }

  Recorded recorded;
  std::optional<ClientSessions> sessions;
  Session page{{}, 0};
  std::string past;
};

TEST(TimeLine, AWelcomeTellsItsLengthItsForcesAndItsPast) {
  Pages pages;
  const auto texts = pages.said();
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[0]["timeline"], json({{"length", 10.0}}));
  EXPECT_EQ(texts[1], json({{"type", "envelope"}, {"forces", {0.0, 1.5}}}));
  ASSERT_EQ(pages.past.size(), 16u + 2 * 16);
  EXPECT_EQ(u8(pages.past, 0), 4);
  EXPECT_EQ(u8(pages.past, 1), 0);
  EXPECT_EQ(u32(pages.past, 4), 2u);
  EXPECT_EQ(test::number_at<double>(pages.past, 8), 7.5);
  EXPECT_EQ(f32(pages.past, 16), -0.5F);
  EXPECT_EQ(f32(pages.past, 28), 3.F);
  EXPECT_EQ(f32(pages.past, 32), 0.F);
  EXPECT_EQ(f32(pages.past, 36), 4.F);
}

TEST(TimeLine, PagesSeekAndPlayAndAreToldOfEachChange) {
  Pages pages;
  pages.said();
  const auto sought = pages.answers(R"({"type":"seek","time":2.5})");
  ASSERT_EQ(sought.size(), 1u);
  EXPECT_EQ(sought[0], json({{"type", "time"}, {"time", 2.5}, {"playing", false}, {"speed", 1.0}}));
  EXPECT_EQ(pages.answers(R"({"type":"play","on":true,"speed":0.25})").at(0)["speed"], 0.25);
  EXPECT_TRUE(pages.recorded.moment.playing);
  EXPECT_TRUE(pages.answers(R"({"type":"seek","time":2.5})").empty()) << "nothing is new";
}

TEST(TimeLine, WhatActsOnARunIsRefused) {
  Pages pages;
  pages.said();
  for (const char* text :
       {R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})",
        R"({"type":"set","key":"k","value":1})", R"({"type":"record","on":true})",
        R"({"type":"seek","time":-1})", R"({"type":"seek","time":"soon"})",
        R"({"type":"play","on":true,"speed":100})", R"({"type":"play","speed":1})"}) {
    const auto answers = pages.answers(text);
    const auto refused = std::ranges::count(
        answers, "refused", [](const json& each) { return each["type"].get<std::string>(); });
    EXPECT_EQ(refused, 1) << text;
  }
  EXPECT_EQ(pages.recorded.moment, TimeLine::Moment{});
}

TEST(TimeLine, ARunHasNone) {
  SessionsRig rig;
  Session& session = rig.enter();
  rig.expect_refused(session, R"({"type":"seek","time":1})");
  rig.expect_refused(session, R"({"type":"play","on":true,"speed":1})");
}

// A viewer of a servo that nobody steps: pause and reset are refused, and a jump is told.
TEST(TimeLine, AViewerShowsStatesThatNoServoMade) {
  Recorded recorded;
  test::ViewerRig rig({}, recorded.controls);
  auto client = rig.enter();
  client->send_text(R"({"type":"pause","on":true})");
  EXPECT_TRUE(client->receive_json("refused").contains("text"));
  client->send_text(R"({"type":"reset"})");
  EXPECT_TRUE(client->receive_json("refused").contains("text"));
  EXPECT_FALSE(rig.servo->state().paused);
  rig.viewer->time_line_changed();
  EXPECT_EQ(client->receive_json("envelope")["forces"].size(), 2u);
  rig.viewer->envelope_changed();
  EXPECT_EQ(client->receive_json("envelope")["forces"].size(), 2u);
}

TEST(TimeLine, StatesThatGoBackInTimeAreReportedAsTheyAre) {
  test::ViewerRig rig;
  StateReporter reporter(*rig.servo, 0, Eigen::Vector3d::Zero());
  ServoTrace trace(*rig.servo);
  (void)reporter.next(0, 1e-3, false);
  ServoState state;
  for (const double time : {100.0, 3.0, 3.001, 50.0}) {
    state.step = static_cast<std::uint64_t>(1000 * time);
    state.time = time;
    state.dt = 1e-3;
    state.hip = {time, 0, 0};
    state.force = {0, time, 0};
    trace.show(state);
    const auto message = reporter.next(time, 1e-3, false);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->time, time);
    EXPECT_EQ(message->hip.x(), static_cast<float>(time));
    ASSERT_EQ(message->forces.size(), 1u) << "of the step that was shown, and of no other";
    EXPECT_EQ(message->forces[0].y(), static_cast<float>(time));
    EXPECT_GT(message->interval, 0);
  }
}

TEST(ClientSessions, APageThatComesLaterIsToldOfARecordingThatGoesOn) {
  ClientSessionsOptions options;
  options.token = "secret";
  options.controls.recording = "run.mcap";
  options.welcome = [] { return Welcome{}; };
  ClientSessions sessions(std::move(options));
  Session page{{}, 0};
  sessions.join(page);
  sessions.receive(page, kHello, 0);
  const auto texts = SessionsRig::said(page);
  ASSERT_EQ(texts.size(), 2u);
  EXPECT_EQ(texts[1], json({{"type", "record"}, {"on", true}, {"file", "run.mcap"}}));
  sessions.end_record();
  EXPECT_EQ(SessionsRig::said(page).at(0)["on"], false);
}

}  // namespace
}  // namespace palpate::viewer
