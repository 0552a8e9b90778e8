#include "apps/palpate/replay/replay_view.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/replay/player.hpp"
#include "apps/palpate/view/address.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kLook{50};

ViewerControls::TimeLine time_line_of(Player& player) {
  ViewerControls::TimeLine line;
  line.length = player.length();
  line.moment = [&] { return player.moment(); };
  line.seek = [&](double time) { player.seek(time); };
  line.play = [&](bool on, double speed) { player.play(on, speed); };
  line.envelope = [&] { return player.envelope(); };
  line.past = [&](std::size_t hand) { return player.past(hand); };
  return line;
}

}  // namespace

void view_recording(const std::string& path, const PagePlan& page) {
  Player player(path);
  ViewerOptions options;
  if (!page.address.empty()) options.address = page.address;
  options.port = page.port;
  options.up = page.up;
  if (player.in_picture_axes()) {
    options.eye = player.scene().source(0).pose().translation();
    if (!page.up) options.up = -Eigen::Vector3d::UnitY();
  }
  options.scene = std::filesystem::path(path).filename();
  options.streams = [&] { return player.streams(); };
  ViewerControls controls;
  controls.time_line = time_line_of(player);
  Viewer viewer(player.scene(), player.servos(), options, controls);
  player.start({[&] { viewer.time_line_changed(); },
                [&](const std::string& why) {
                  viewer.notice(Viewer::NoticeLevel::warning, why);
                  fmt::print(stderr, "{}: {}\n", path, why);
                }});
  const Interruption interruption;
  tell_page(viewer.url(), page.address);
  std::optional<Browser> browser;
  if (page.open_browser) browser.emplace(viewer.url());
  while (!interruption.asked()) std::this_thread::sleep_for(kLook);
  player.stop();  // what it tells, it tells the viewer
}

}  // namespace palpate::app
