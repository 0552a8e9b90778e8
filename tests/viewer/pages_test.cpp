// What pages are told and shown that come late, draw nothing, or find no place.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "palpate/base/error.hpp"
#include "palpate/scene/scene_field.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::Frame;
using test::RawClient;
using test::ViewerRig;

TEST(Pages, OneThatComesLaterHearsOfAFaultThatLasts) {
  ViewerRig rig;
  auto first = rig.enter();
  rig.device.state().position.x() = std::nan("");
  rig.servo->tick(0.1);
  const auto notice = first->receive_json("notice");
  EXPECT_EQ(notice["level"], "fault");
  EXPECT_EQ(rig.enter()->receive_json("notice"), notice);
}

TEST(Pages, AreToldWhyADeviceIsSilent) {
  ViewerRig rig;
  const auto client = rig.enter();
  const auto told = [&] { return client->receive_json("devices")["devices"].at(0); };
  EXPECT_EQ(told(), nlohmann::json({{"status", "ok"}}));
  rig.device.state().status = DeviceState::Status::silent;
  rig.press(0.021);
  nlohmann::json device = told();
  while (device["status"] == "ok") device = told();
  EXPECT_EQ(device, nlohmann::json({{"status", "silent"}, {"reason", "told to"}}));
}

TEST(Pages, ShowWhatARobotDoes) {
  ViewerOptions options;
  options.robot = [] { return "robot WAITS: nothing is measured where the tool is"; };
  ViewerRig rig(options);
  EXPECT_EQ(rig.enter()->receive_json("sources")["robot"],
            "robot WAITS: nothing is measured where the tool is");
}

TEST(Pages, NobodyHearsOfAProblemThatIsOver) {
  StreamState stream;
  stream.source = "sheet";
  stream.phase = StreamState::Phase::running;
  stream.problem = "sheet (a camera): one bad frame";
  ViewerOptions options;
  options.streams = [&] { return std::vector{ViewerOptions::Stream{stream}}; };
  ViewerRig rig(options);
  auto client = rig.enter();
  for (int i = 0; i < 3; ++i) client->receive_json("sources");
  rig.viewer->notice(Viewer::NoticeLevel::info, "the first");
  EXPECT_EQ(client->receive_json("notice")["text"], "the first");
}

TEST(Pages, ASceneThatHasNoPlaceForAFieldIsSeenAllTheSame) {
  ViewerRig rig;
  std::deque<SceneField> fields;
  try {
    while (true) fields.emplace_back(rig.scene);
  } catch (const Error&) {
    EXPECT_FALSE(fields.empty());
  }
  auto client = rig.enter();
  client->receive_until([](const Frame& frame) { return frame.binary(2); });
  auto other = rig.enter();
  other->receive_until([](const Frame& frame) { return frame.binary(2); });
  fields.pop_back();
  client->receive_until([](const Frame& frame) { return frame.binary(3); });
}

TEST(Pages, TheOriginIsNearSensorsThatSawNothingYet) {
  Scene scene;
  const Eigen::Vector3d middle(500'000, 4'000'000, 100);
  for (const double side : {-1.0, 1.0}) {
    Source& source = scene.add(side < 0 ? "left" : "right");
    source.set_pose(Eigen::Isometry3d(Eigen::Translation3d(middle + Eigen::Vector3d(side, 0, 0))));
  }
  ViewerOptions options;
  options.port = 0;
  options.token = ViewerRig::kToken;
  const Viewer viewer(scene, {}, options);
  RawClient client(viewer.port());
  client.upgrade(test::local(viewer.port()));
  client.send_text(R"({"type":"hello","token":"secret","points":10})");
  EXPECT_EQ(client.receive_json("welcome")["origin"],
            nlohmann::json::array({500'000.0, 4'000'000.0, 100.0}));
}

TEST(Pages, OneThatDrawsNothingGetsNoCloudAndNoSurfaceUntilItDraws) {
  ViewerRig rig;
  auto client = rig.enter(0);
  int reports = 0;
  client->receive_until([&](const Frame& frame) {
    EXPECT_FALSE(frame.binary(2) || frame.binary(3));
    return frame.opcode == 1 && frame.payload.find("\"sources\"") != std::string::npos &&
           ++reports == 3;
  });
  client->send_text(R"({"type":"points","points":100})");
  client->receive_until([](const Frame& frame) { return frame.binary(2); });
  client->receive_until([](const Frame& frame) { return frame.binary(3); });
}

TEST(Viewer, WorkUnderWayIsToldToWhoComesLaterUntilItIsDone) {
  ViewerRig rig;
  rig.viewer->progress("reading table.ply", 0.25);
  const auto first = rig.enter();
  const auto notice = first->receive_json("notice");
  EXPECT_EQ(notice["text"], "reading table.ply");
  EXPECT_EQ(notice["share"], 0.25);
  EXPECT_EQ(rig.enter()->receive_json("notice"), notice);
  rig.viewer->progress("reading table.ply", 1);
  EXPECT_EQ(first->receive_json("notice")["share"], 1);
  const auto late = rig.enter();
  rig.viewer->notice(Viewer::NoticeLevel::info, "the next");
  EXPECT_EQ(late->receive_json("notice")["text"], "the next") << "nothing of what is done";
}

TEST(Pages, WhatBeginsTheRunAnewAndWhatIsAskedIsTold) {
  ViewerControls controls;
  controls.settings = [] {
    ViewerControls::Setting unit{.key = "unit.cube", .label = "Unit of cube"};
    unit.kind = ViewerControls::Setting::Kind::choice;
    unit.choices = {"mm", "m"};
    unit.value = std::string("mm");
    unit.restarts = true;
    unit.question = "cube: 20 x 20 x 20 mm?";
    return std::vector{unit};
  };
  controls.scale = [](std::size_t) { return 250.0; };
  ViewerRig rig({}, controls);
  const auto client = rig.connect();
  client->send_text(R"({"type":"hello","token":"secret","points":0})");
  const auto welcome = client->receive_json("welcome");
  EXPECT_EQ(welcome["settings"][0]["restarts"], true);
  EXPECT_EQ(welcome["settings"][0]["question"], "cube: 20 x 20 x 20 mm?");
  EXPECT_EQ(welcome["devices"][0]["scale"], 250.0);
}

}  // namespace
}  // namespace palpate
