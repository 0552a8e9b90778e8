// Replays a recording, and speaks the page's protocol.
#include "tab/tab_replay.hpp"

#include <exception>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "session/played_run.hpp"
#include "session/view_settings.hpp"
#include "tab/tab_page.hpp"

namespace palpate::tab {
namespace {

using session::Setting;

// Steps that one run() reads for the envelope: 0.4 ms in WebAssembly, of the four after which a
// browser calls it again (judgement).
constexpr std::size_t kAhead = 200;

}  // namespace

struct TabReplay::Parts {
  Parts(bag::RandomFile file, Outside outside, const Clock& clock, const std::string& news)
      : name(std::filesystem::path(file.path()).filename()),
        stopwatch(clock),
        played(std::move(file)),
        page(played.scene(), played.servos(), played.viewer_options(), controls(),
             std::move(outside), stopwatch, news) {
    tell_losses();
  }

  [[nodiscard]] ViewerControls controls() {
    ViewerControls controls;
    controls.time_line = played.time_line();
    controls.settings = [this] { return std::vector{scene_setting(name)}; };
    controls.set = [this](const std::string&, const Setting::Value& value) {
      page.outside().open(name_of_scene(value));
    };
    return controls;
  }

  void complain(const std::exception& error) { page.warn(words_of(error, name)); }

  // The first of what is damaged and was not told yet.
  void tell_losses() {
    const std::vector<std::string>& losses = played.losses();
    const std::size_t known = std::exchange(told_losses, losses.size());
    if (known < losses.size()) page.warn(name + ": " + losses[known]);
  }

  void show(double elapsed) {
    const bool jumped = played.show(
        elapsed, [] { return false; }, [this](const std::exception& error) { complain(error); });
    if (jumped) page.sessions().send_time_line();
  }

  // Frames that take long to prepare come seldom.
  void show_frames(double now) {
    if (!played.has_cameras() || now < next_frame || played.moment().time == frame) return;
    const double begin = stopwatch.now();
    frame = played.show_frames([this](const std::exception& error) { complain(error); });
    next_frame = now + viewer::SceneEncoder::pause_after(stopwatch.now() - begin);
  }

  void read_ahead(double now) {
    if (!reading) return;
    reading = false;
    try {
      reading = played.read_forces(kAhead);
    } catch (const std::exception& error) {
      complain(error);
    }
    if (reading && now - told < session::PlayedRun::kNews) return;
    told = now;
    page.sessions().send_envelope();
    if (!reading) tell_losses();
  }

  std::string name;
  const Clock& stopwatch;
  session::PlayedRun played;
  TabPage page;
  std::optional<double> last = {};   // when run() was called
  std::optional<double> frame = {};  // the moment whose frames are shown
  double next_frame = -1e300;
  double told = -1e300;  // when the envelope was
  std::size_t told_losses = 0;
  bool reading = true;
};

TabReplay::TabReplay(bag::RandomFile file, Outside outside, const Clock& stopwatch,
                     const std::string& news)
    : parts_(std::make_unique<Parts>(std::move(file), std::move(outside), stopwatch, news)) {}

TabReplay::~TabReplay() = default;

void TabReplay::connect(double now) {
  parts_->page.connect(now);
}

void TabReplay::receive(std::string_view text, double now) {
  parts_->page.receive(text, now);
}

int TabReplay::run(double now) {
  Parts& parts = *parts_;
  const double elapsed = now - parts.last.value_or(now);
  parts.last = now;
  parts.show(elapsed);
  parts.show_frames(now);
  parts.read_ahead(now);
  parts.page.tell(now);
  return 0;
}

}  // namespace palpate::tab
