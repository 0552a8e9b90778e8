// Plays a recorded run in real time.
#include "apps/palpate/replay/playback.hpp"

#include <chrono>
#include <exception>
#include <utility>

#include "palpate/base/clock.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kPicture{8};  // between shown steps: 125 Hz; judgement
constexpr std::chrono::milliseconds kFrame{25};   // between looks for frames: 40 Hz; judgement

}  // namespace

Playback::Playback(const std::string& path) : run_(bag::RandomFile(path), [this] { wake(); }) {}

Playback::~Playback() {
  stop();
}

void Playback::start(Listener listener) {
  listener_ = std::move(listener);
  const auto run = [this](void (Playback::*work)(const std::stop_token&)) {
    threads_.emplace_back(
        [this, work](const std::stop_token& stop) { guard([&] { (this->*work)(stop); }); });
  };
  run(&Playback::show_steps);
  run(&Playback::read_forces);
  if (run_.has_cameras()) run(&Playback::show_frames);
}

void Playback::stop() {
  threads_.clear();
}

void Playback::wake() {
  { const std::lock_guard lock(mutex_); }
  changed_.notify_all();
}

// Damaged data end what is done with them alone.
void Playback::guard(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    listener_.complain(error.what());
  }
}

void Playback::show_steps(const std::stop_token& stop) {
  const SteadyClock clock;
  double looked = clock.now();
  const auto stopped = [&] { return stop.stop_requested(); };
  while (!stopped()) {
    {
      std::unique_lock lock(mutex_);
      const auto called = [this] { return run_.is_sought(); };
      if (run_.moment().playing) {
        changed_.wait_for(lock, stop, kPicture, called);
      } else {
        changed_.wait(lock, stop, [&] { return called() || run_.moment().playing; });
        looked = clock.now();
      }
    }
    const double now = clock.now();
    const bool jumped = run_.show(now - looked, stopped, [this](const std::exception& error) {
      listener_.complain(error.what());
    });
    looked = jumped ? clock.now() : now;
    if (jumped && !stopped() && !run_.is_sought()) listener_.changed();
  }
}

void Playback::show_frames(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const double time =
        run_.show_frames([this](const std::exception& error) { listener_.complain(error.what()); });
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, kFrame, [] { return false; });
    changed_.wait(lock, stop, [&] {
      const TimeLine::Moment moment = run_.moment();
      return moment.playing || moment.time != time;
    });
  }
}

void Playback::read_forces(const std::stop_token& stop) {
  const SteadyClock clock;
  double notified = clock.now();
  guard([&] {
    while (!stop.stop_requested() && run_.read_forces(1)) {
      if (clock.now() - notified < session::PlayedRun::kNews) continue;
      notified = clock.now();
      listener_.envelope();
    }
  });
  if (stop.stop_requested()) return;
  listener_.envelope();
  if (!run_.losses().empty()) listener_.complain(run_.losses().front());
}

}  // namespace palpate::app
