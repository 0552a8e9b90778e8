// Serves the page of a recording.
#include "apps/palpate/replay/replay_view.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/replay/playback.hpp"
#include "apps/palpate/view/address.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kLook{50};

}  // namespace

void view_recording(const std::string& path, const PagePlan& page) {
  Playback playback(path);
  ViewerOptions options = playback.viewer_options();
  if (!page.address.empty()) options.address = page.address;
  options.port = page.port;
  if (page.up) options.up = page.up;
  ViewerControls controls;
  controls.time_line = playback.time_line();
  Viewer viewer(playback.scene(), playback.servos(), options, controls);
  playback.start({[&] { viewer.time_line_changed(); }, [&] { viewer.envelope_changed(); },
                  [&](const std::string& why) {
                    viewer.notice(Viewer::NoticeLevel::warning, why);
                    fmt::print(stderr, "{}\n", why);
                  }});
  const Interruption interruption;
  announce_page(viewer.url(), page.address);
  std::optional<Browser> browser;
  if (!page.headless) browser.emplace(viewer.url());
  while (!interruption.requested()) std::this_thread::sleep_for(kLook);
  playback.stop();  // its listener is the viewer
}

}  // namespace palpate::app
