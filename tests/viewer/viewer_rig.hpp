#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/viewer/viewer.hpp"
#include "servo/servo_rig.hpp"
#include "viewer/raw_client.hpp"

namespace palpate::test {

/// A sheet, a hand that presses on it, and a viewer on any free port.
struct ViewerRig {
  explicit ViewerRig(ViewerOptions options = {}, ViewerControls controls = {}) {
    add_sheet(scene);
    servo.emplace(device, scene, first_links());
    for (int i = 1; i <= 20; ++i) press(1e-3 * i);
    options.port = 0;
    options.token = kToken;
    options.origin = kOrigin;
    viewer.emplace(scene, std::vector<Servo*>{&*servo}, options, std::move(controls));
  }

  void press(double time) {
    device.state().position = {0.3e-3, 0.4e-3, 6e-3 - 0.5 * time};
    servo->tick(time);
  }
  [[nodiscard]] std::string host() const { return local(viewer->port()); }

  /// A client that was welcomed.
  [[nodiscard]] std::unique_ptr<RawClient> enter(int points = 500) {
    auto client = connect();
    client->send_text(R"({"type":"hello","token":"secret","points":)" + std::to_string(points) +
                      "}");
    client->receive_json("welcome");
    return client;
  }
  /// A client that said nothing yet.
  [[nodiscard]] std::unique_ptr<RawClient> connect() {
    auto client = std::make_unique<RawClient>(viewer->port());
    const std::string header = client->upgrade(host(), "http://" + host());
    if (!header.starts_with("HTTP/1.1 101")) throw std::runtime_error("no upgrade: " + header);
    return client;
  }
  /// Returns once the counts are so; hangs otherwise, until the test's time is over.
  void wait(const std::function<bool(const Viewer::Counts&)>& so) const {
    while (!so(viewer->counts())) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  static constexpr const char* kToken = "secret";
  inline static const Eigen::Vector3d kOrigin{0, 0, 1};

  Scene scene;
  FreeDevice device;
  std::optional<Servo> servo;
  std::optional<Viewer> viewer;
};

}  // namespace palpate::test
