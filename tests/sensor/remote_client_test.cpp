// The clients of examples/ at a real remote camera in real time.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>
#include <thread>

#include "palpate/sensor/depth_camera.hpp"
#include "sensor/remote_sender.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate::sensor {
namespace {

struct Session {
  std::string printed;
  int status = -1;  // of its end
};

Session run(const std::string& command) {
  Session session;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return session;
  std::array<char, 200> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) session.printed += line.data();
  session.status = ::pclose(pipe);
  return session;
}

struct Seen {
  int frames = 0;
  int wrong = 0;
  float nearest = 1;
  float farthest = 0;
};

void look_at(const DepthFrame& frame, Seen& seen) {
  ++seen.frames;
  const Pinhole& p = frame.camera.pinhole;
  const bool lens = p.fx == 285 && p.fy == 285 && p.cx == 159.5 && p.cy == 119.5;
  if (!lens || frame.camera.width != 320 || frame.camera.height != 240) ++seen.wrong;
  for (const float z : frame.depth) {
    if (z != frame.depth[0]) ++seen.wrong;
  }
  seen.nearest = std::min(seen.nearest, frame.depth[0]);
  seen.farthest = std::max(seen.farthest, frame.depth[0]);
}

void check(const std::string& program) {
  const test::Folder folder;
  const std::string path = folder / "camera";
  const auto camera = open_camera("remote:" + path);
  Seen seen;
  std::string damage;
  std::jthread reader([&](const std::stop_token& stop) {
    DepthFrame frame;
    while (!stop.stop_requested()) {
      const DepthCamera::Status status = camera->read(frame, 0.05);
      if (status == DepthCamera::Status::frame) look_at(frame, seen);
      if (status == DepthCamera::Status::damaged) damage = camera->reason();
    }
  });
  const Session session = run(program + " " + path + " 2");
  reader.request_stop();
  reader.join();
  SCOPED_TRACE(session.printed);
  EXPECT_EQ(session.status, 0);
  EXPECT_EQ(damage, "");
  int sent = 0;
  ASSERT_EQ(std::sscanf(session.printed.c_str(), "%d frames", &sent), 1);
  EXPECT_GT(sent, 2);
  EXPECT_GT(seen.frames, 2);
  EXPECT_LE(seen.frames, sent);
  EXPECT_EQ(seen.wrong, 0);
  EXPECT_GE(seen.nearest, 0.695F);
  EXPECT_LE(seen.farthest, 0.705F);
  EXPECT_GT(seen.farthest - seen.nearest, 1e-4F) << "it moves";
}

// It says why it is not served.
void check_refusal(const std::string& program) {
  const test::Folder folder;
  const std::string path = folder / "camera";
  const auto camera = open_camera("remote:" + path);
  const test::RemoteSender first(path);
  DepthFrame frame;
  ASSERT_EQ(camera->read(frame, 0), DepthCamera::Status::waiting);
  std::jthread reader([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) static_cast<void>(camera->read(frame, 0.05));
  });
  const Session session = run(program + " " + path);
  EXPECT_NE(session.status, 0);
  EXPECT_TRUE(test::contains(session.printed, "another program is this camera")) << session.printed;
}

TEST(RemoteCameraClient, InCIsACamera) {
  const std::string program = PALPATE_CLIENT_C;
  if (program.empty()) GTEST_SKIP() << "the examples are not built";
  check(program);
  check_refusal(program);
}

TEST(RemoteCameraClient, InPythonIsACamera) {
  const std::string program = PALPATE_CLIENT_PYTHON;
  if (program.empty()) GTEST_SKIP() << "there is no python3";
  check(program);
  check_refusal(program);
}

}  // namespace
}  // namespace palpate::sensor
