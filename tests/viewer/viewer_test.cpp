#include "palpate/viewer/viewer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <deque>
#include <mutex>

#include "palpate/base/error.hpp"
#include "palpate/scene/scene_field.hpp"
#include "viewer/bytes.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::f32;
using test::Frame;
using test::RawClient;
using test::ViewerRig;

std::string get(std::uint16_t port, const std::string& path, const std::string& host,
                const std::string& more = "") {
  RawClient client(port);
  client.send("GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n");
  const std::string header = client.read_header();
  return header + client.read_body(header);
}

int status(const std::string& answer) {
  return std::stoi(answer.substr(answer.find(' ') + 1));
}

TEST(Viewer, ServesThePageWithHeadersThatKeepItToItself) {
  ViewerRig rig;
  const std::string page = get(rig.viewer->port(), "/", rig.host());
  EXPECT_EQ(status(page), 200);
  EXPECT_NE(page.find("<!doctype html"), std::string::npos);
  for (const char* header : {"Content-Security-Policy: default-src 'self'",
                             "connect-src 'self'; img-src 'self' data: blob:",
                             "X-Content-Type-Options: nosniff", "Cache-Control: no-store"}) {
    EXPECT_NE(page.find(header), std::string::npos) << header;
  }
  EXPECT_EQ(status(get(rig.viewer->port(), "/?a=1", rig.host())), 200);
  EXPECT_EQ(status(get(rig.viewer->port(), "/../etc/passwd", rig.host())), 404);
  EXPECT_EQ(status(get(rig.viewer->port(), "/live", rig.host())), 426);
}

TEST(Viewer, TheUrlEndsInTheToken) {
  ViewerRig rig;
  EXPECT_EQ(rig.viewer->url(), "http://" + rig.host() + "/#secret");
  Scene scene;
  ViewerOptions options;
  options.port = 0;
  const Viewer viewer(scene, {}, options);
  EXPECT_EQ(viewer.url().size(),
            std::string("http://127.0.0.1:/#").size() + std::to_string(viewer.port()).size() + 32);
}

TEST(Viewer, APortThatIsTakenIsSaid) {
  ViewerRig rig;
  ViewerOptions options;
  options.port = rig.viewer->port();
  EXPECT_THROW(Viewer(rig.scene, {}, options), Error);
  options.port = 0;
  options.address = "nowhere";
  EXPECT_THROW(Viewer(rig.scene, {}, options), Error);
}

TEST(Viewer, AnswersToItsOwnNamesAlone) {
  ViewerRig rig;
  const std::uint16_t port = rig.viewer->port();
  EXPECT_EQ(status(get(port, "/", "evil.example:" + std::to_string(port))), 403);
  EXPECT_EQ(status(get(port, "/", "127.0.0.1:1")), 403);
  EXPECT_EQ(status(get(port, "/", "localhost:" + std::to_string(port))), 200);
  EXPECT_EQ(status(get(port, "/", rig.host(), "Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(status(get(port, "/", rig.host(), "Host: " + rig.host() + "\r\n")), 403);
  RawClient foreign(port);
  EXPECT_EQ(status(foreign.upgrade(rig.host(), "http://evil.example")), 403);
  RawClient misnamed(port);
  EXPECT_EQ(status(misnamed.upgrade("evil.example", "http://evil.example")), 403);
  rig.wait([](const Viewer::Counts& counts) { return counts.forbidden == 6; });
}

TEST(Viewer, WelcomesWhoKnowsTheToken) {
  ViewerRig rig;
  auto client = rig.connect();
  client->send_text(R"({"type":"hello","token":"secret","points":10})");
  const auto welcome = client->receive_json("welcome");
  EXPECT_EQ(welcome["origin"], nlohmann::json::array({0.0, 0.0, 1.0}));
  EXPECT_EQ(welcome["sources"][0]["name"], "sheet");
  EXPECT_EQ(welcome["sources"][0]["camera"], false);
  EXPECT_EQ(welcome["devices"][0]["name"], "free");
  EXPECT_EQ(welcome["devices"][0]["takeable"], false);
  EXPECT_NEAR(welcome["radius"].get<double>(), 0.06 * std::sqrt(2.0), 1e-6);
  const auto sources = client->receive_json("sources");
  EXPECT_FALSE(sources.contains("robot"));
  EXPECT_EQ(sources["sources"][0]["phase"], "still");
  EXPECT_EQ(sources["sources"][0]["points"], 31 * 31);
}

TEST(Viewer, AWrongTokenClosesWith1008) {
  ViewerRig rig;
  auto client = rig.connect();
  client->send_text(R"({"type":"hello","token":"guess","points":10})");
  EXPECT_EQ(client->receive_close(), 1008);
}

TEST(Viewer, ShowsTheServosState) {
  ViewerRig rig;
  auto client = rig.enter();
  const Frame frame = client->receive_until([](const Frame& f) {
    return f.binary(1) && f32(f.payload, 64) > 0;  // once R is known
  });
  const ServoState state = rig.servo->state();
  ASSERT_TRUE(state.contact.touching);
  EXPECT_EQ(test::u32(frame.payload, 4) & 1, 1u);
  EXPECT_EQ(test::number_at<double>(frame.payload, 8), state.time);
  EXPECT_FLOAT_EQ(f32(frame.payload, 24), static_cast<float>(state.hip.z() - 1));
  EXPECT_FLOAT_EQ(f32(frame.payload, 60), static_cast<float>(state.force.z()));
  EXPECT_NEAR(f32(frame.payload, 64), 10e-3, 1e-6);
}

TEST(Viewer, TellsThatAStiffnessWaitsForMotion) {
  ViewerRig rig;
  auto client = rig.enter();
  const Frame before = client->receive_until([](const Frame& f) { return f.binary(1); });
  EXPECT_EQ(test::u32(before.payload, 4) & 256, 0u);
  rig.servo->set_contact({.stiffness = 2000});
  rig.press(0.021);
  client->receive_until(
      [](const Frame& f) { return f.binary(1) && (test::u32(f.payload, 4) & 256) != 0; });
}

TEST(Viewer, TellsTheForceOfEveryStepOnce) {
  ViewerRig rig;
  auto client = rig.enter();
  client->receive_until([](const Frame& f) { return f.binary(1); });
  client->receive_until([](const Frame& f) { return f.binary(1) && test::u16(f.payload, 2) == 0; });
  for (int i = 21; i <= 60; ++i) rig.press(1e-3 * i);
  std::size_t samples = 0;
  float last = 0;
  while (samples < 40) {
    const Frame frame = client->receive_until([](const Frame& f) { return f.binary(1); });
    const std::size_t n = test::u16(frame.payload, 2);
    samples += n;
    if (n > 0) last = f32(frame.payload, 92 + 12 * n - 4);
  }
  EXPECT_EQ(samples, 40u);
  EXPECT_FLOAT_EQ(last, static_cast<float>(rig.servo->state().force.z()));
}

TEST(Viewer, SendsEachSourcesCloudThinnedToWhatThePageAskedFor) {
  ViewerRig rig;
  auto client = rig.enter(100);
  const auto cloud = [](const Frame& f) { return f.binary(2); };
  const std::string few = client->receive_until(cloud).payload;
  EXPECT_EQ(test::u32(few, 4), 100u);
  EXPECT_EQ(test::u16(few, 2), 14);
  EXPECT_NEAR(f32(few, 24), -1, 1e-6);  // z of the lower corner, from the origin
  client->send_text(R"({"type":"points","points":100000})");
  EXPECT_EQ(test::u32(client->receive_until(cloud).payload, 4), 31u * 31);
}

TEST(Viewer, SendsANewCloudWhenTheSourceHasOne) {
  ViewerRig rig;
  auto client = rig.enter(100'000);
  const auto cloud = [](const Frame& f) { return f.binary(2); };
  client->receive_until(cloud);
  rig.scene.source(0).publish(test::still(test::plane(0.25, 4e-3, 2)));
  const std::string newer = client->receive_until(cloud).payload;
  EXPECT_EQ(test::u32(newer, 4), 25u);
  EXPECT_NEAR(f32(newer, 24), -0.75, 1e-6);
}

TEST(Viewer, SendsTheSurfaceAroundTheTool) {
  ViewerRig rig;
  auto client = rig.enter();
  const std::string mesh =
      client->receive_until([](const Frame& f) { return f.binary(3); }).payload;
  const std::size_t vertices = test::u16(mesh, 2);
  ASSERT_GT(vertices, 100u);
  EXPECT_GT(test::u32(mesh, 4), 100u);
  EXPECT_EQ(mesh.size(), 24 + 6 * vertices + 6 * test::u32(mesh, 4));
  const float extent = f32(mesh, 20);
  for (std::size_t v = 0; v < vertices; ++v) {
    const double z = f32(mesh, 16) + 1 + extent * test::i16(mesh, 24 + 6 * v + 4) / 32767.0;
    EXPECT_NEAR(z, 0, 1e-3);
  }
}

TEST(Viewer, ASettingReachesTheProgram) {
  std::mutex mutex;
  ViewerControls::Setting setting{
      .key = "k", .label = "Stiffness", .least = 0, .most = 1000, .value = 500.0};
  ViewerControls controls;
  controls.settings = [&] {
    const std::lock_guard lock(mutex);
    return std::vector{setting};
  };
  controls.set = [&](const std::string& key, const ViewerControls::Setting::Value& value) {
    const std::lock_guard lock(mutex);
    EXPECT_EQ(key, "k");
    setting.value = value;
  };
  ViewerRig rig({}, controls);
  auto client = rig.enter();
  auto other = rig.enter();
  client->send_text(R"({"type":"set","key":"k","value":750})");
  EXPECT_EQ(other->receive_json("settings")["values"]["k"], 750.0);
  client->send_text(R"({"type":"set","key":"k","value":7500})");
  EXPECT_NE(client->receive_json("refused")["text"].get<std::string>().find("Stiffness"),
            std::string::npos);
  const std::lock_guard lock(mutex);
  EXPECT_EQ(setting.value, ViewerControls::Setting::Value{750.0});
}

TEST(Viewer, PausesAndResetsItsServosByItself) {
  ViewerRig rig;
  auto client = rig.enter();
  client->send_text(R"({"type":"pause","on":true})");
  client->send_text(R"({"type":"ping","id":1})");
  EXPECT_EQ(client->receive_json("pong")["id"], 1);
  rig.press(0.03);
  EXPECT_TRUE(rig.servo->state().paused);
  const Frame frame = client->receive_until(
      [](const Frame& f) { return f.binary(1) && (test::u32(f.payload, 4) & 2) != 0; });
  EXPECT_FALSE(frame.payload.empty());
  rig.device.state().position.x() = std::nan("");
  rig.servo->tick(0.031);
  ASSERT_NE(rig.servo->state().guard.fault, Guard::Fault::none);
  client->send_text(R"({"type":"reset"})");
  client->send_text(R"({"type":"ping","id":2})");
  EXPECT_EQ(client->receive_json("pong")["id"], 2);
  rig.press(0.032);
  EXPECT_EQ(rig.servo->state().guard.fault, Guard::Fault::none);
}

TEST(Viewer, AHandIsReleasedWhenItsPageGoesAway) {
  std::atomic<int> released{0};
  std::atomic<double> height{0};
  ViewerControls controls;
  controls.hand = [&](std::size_t, const TargetSource::Target& target, const auto& /*eye*/) {
    const Eigen::Vector3d& place = target.position;
    height = place.z();
  };
  controls.release = [&](std::size_t) { ++released; };
  ViewerRig rig({}, controls);
  auto client = rig.enter();
  client->send_text(R"({"type":"hand","device":0,"position":[0,0,0.5],"buttons":1})");
  client->receive_until(
      [](const Frame& f) { return f.binary(1) && (test::u32(f.payload, 4) & 4) != 0; });
  EXPECT_EQ(height, 1.5);
  EXPECT_EQ(released, 0);
  client.reset();
  rig.wait([&](const Viewer::Counts&) { return released == 1; });
}

TEST(Viewer, NoticesReachEveryPage) {
  ViewerRig rig;
  const std::array clients{rig.enter(), rig.enter()};
  rig.viewer->notice(Viewer::NoticeLevel::warning, "the lens is covered");
  for (const auto& client : clients) {
    const auto notice = client->receive_json("notice");
    EXPECT_EQ(notice["level"], "warning");
    EXPECT_EQ(notice["text"], "the lens is covered");
  }
  rig.device.state().position.x() = std::nan("");
  rig.servo->tick(0.1);
  for (const auto& client : clients) EXPECT_EQ(client->receive_json("notice")["level"], "fault");
}

/// How many more fields find a place at the scene.
std::size_t places_left(Scene& scene) {
  std::deque<SceneField> fields;
  try {
    while (true) fields.emplace_back(scene);
  } catch (const Error&) {
    return fields.size();
  }
}

TEST(Viewer, HoldsAFieldOfTheSceneOnlyWhileSomebodyLooks) {
  ViewerRig rig;
  const std::size_t before = places_left(rig.scene);
  auto client = rig.enter();
  client->receive_until([](const Frame& f) { return f.binary(3); });
  EXPECT_EQ(places_left(rig.scene), before - 1);
  client.reset();
  while (places_left(rig.scene) != before) std::this_thread::yield();
}

}  // namespace
}  // namespace palpate
