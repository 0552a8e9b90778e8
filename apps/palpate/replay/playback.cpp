// Plays a recorded run, or shows it at any moment.
#include "apps/palpate/replay/playback.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <utility>

#include "apps/palpate/record/options_json.hpp"
#include "message/transforms.hpp"
#include "palpate/base/clock.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kPicture{8};  // between shown steps: 125 Hz; judgement
constexpr std::chrono::milliseconds kFrame{25};   // between looks for frames: 40 Hz; judgement
constexpr double kNews = 0.5;  // s between two envelopes while the file is read; judgement

}  // namespace

Playback::Playback(const std::string& path)
    : run_(path), envelope_(kEnvelope, 0.0F), pasts_(run_.hands.size()) {
  sought_ = moment_.time = run_.first_surface();  // with its past, once the threads run
  for (ShownHand& hand : run_.hands) {
    hand.seek(run_.stretch.begin + moment_.time);
    fields_.push_back({FieldChange{run_.stretch.begin, hand.servo().field()}});
  }
}

Playback::~Playback() {
  stop();
}

std::vector<Servo*> Playback::servos() {
  std::vector<Servo*> servos;
  for (ShownHand& hand : run_.hands) servos.push_back(&hand.servo());
  return servos;
}

void Playback::start(Listener listener) {
  listener_ = std::move(listener);
  const auto run = [this](void (Playback::*work)(const std::stop_token&)) {
    threads_.emplace_back(
        [this, work](const std::stop_token& stop) { guard([&] { (this->*work)(stop); }); });
  };
  run(&Playback::show_steps);
  run(&Playback::read_forces);
  const bool live = std::ranges::any_of(run_.sources, &ShownSource::lives);
  if (live) run(&Playback::show_frames);
}

void Playback::stop() {
  threads_.clear();
}

// Damaged data end their thread alone.
void Playback::guard(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    listener_.complain(error.what());
  }
}

Playback::TimeLine Playback::time_line() {
  const auto locked = [this](const auto& copy) {
    return [this, copy](auto... which) {
      const std::lock_guard lock(mutex_);
      return copy(which...);
    };
  };
  TimeLine line;
  line.length = run_.length();
  line.moment = locked([this] { return moment_; });
  line.seek = [this](double time) { seek(time); };
  line.play = [this](bool on, double speed) { play(on, speed); };
  line.envelope = locked([this] { return envelope_; });
  line.past = locked([this](std::size_t hand) { return pasts_[hand]; });
  return line;
}

void Playback::seek(double time) {
  {
    const std::lock_guard lock(mutex_);
    sought_ = moment_.time = std::clamp(time, 0.0, run_.length());
  }
  changed_.notify_all();
}

void Playback::play(bool on, double speed) {
  {
    const std::lock_guard lock(mutex_);
    if (on && !moment_.playing && moment_.time >= run_.length()) sought_ = moment_.time = 0;
    moment_.playing = on;
    moment_.speed = speed;
  }
  changed_.notify_all();
}

std::vector<ViewerOptions::Stream> Playback::streams() const {
  std::vector<ViewerOptions::Stream> streams;
  for (const ShownSource& source : run_.sources) {
    if (source.lives()) streams.push_back(source.stream());
  }
  return streams;
}

void Playback::show_steps(const std::stop_token& stop) {
  const SteadyClock clock;
  double looked = clock.now();
  while (!stop.stop_requested()) {
    std::optional<double> sought;
    {
      std::unique_lock lock(mutex_);
      const auto called = [this] { return sought_.has_value(); };
      if (moment_.playing) {
        changed_.wait_for(lock, stop, kPicture, called);
      } else {
        changed_.wait(lock, stop, [&] { return called() || moment_.playing; });
        looked = clock.now();
      }
      sought = std::exchange(sought_, std::nullopt);
    }
    if (sought) jump(*sought, stop);
    const double now = clock.now();
    if (!sought) advance(now - looked);
    looked = now;
  }
}

void Playback::jump(double time, const std::stop_token& stop) {
  for (ShownHand& hand : run_.hands) hand.seek(run_.stretch.begin + time);
  show_fields(run_.stretch.begin + time);
  const auto cancelled = [&] {
    const std::lock_guard lock(mutex_);
    return sought_.has_value() || stop.stop_requested();
  };
  for (std::size_t i = 0; i < run_.hands.size(); ++i) {
    std::vector<TimeLine::Force> past = run_.hands[i].past(kPast, cancelled);
    const std::lock_guard lock(mutex_);
    pasts_[i] = std::move(past);
  }
  if (!cancelled()) listener_.changed();
}

void Playback::advance(double elapsed) {
  double time = 0;
  {
    const std::lock_guard lock(mutex_);
    if (sought_ || !moment_.playing) return;
    time = moment_.time = std::min(moment_.time + elapsed * moment_.speed, run_.length());
    moment_.playing = time < run_.length();
  }
  for (ShownHand& hand : run_.hands) hand.advance(run_.stretch.begin + time);
  show_fields(run_.stretch.begin + time);
}

// The surface around a tool is that of the field which its hand felt.
void Playback::show_fields(double time) {
  for (std::size_t i = 0; i < run_.hands.size(); ++i) {
    FieldOptions field;
    {
      const std::lock_guard lock(mutex_);
      const auto after = std::ranges::upper_bound(fields_[i], time, {}, &FieldChange::time);
      field = (after == fields_[i].begin() ? after : std::prev(after))->field;
    }
    if (field != run_.hands[i].servo().field()) run_.hands[i].servo().set_field(field);
  }
}

void Playback::show_frames(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    double time = 0;
    {
      const std::lock_guard lock(mutex_);
      time = moment_.time;
    }
    for (ShownSource& source : run_.sources) {
      if (source.lives()) guard([&] { source.show(run_.stretch.begin + time); });
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, kFrame, [] { return false; });
    changed_.wait(lock, stop, [&] { return moment_.playing || moment_.time != time; });
  }
}

void Playback::read_forces(const std::stop_token& stop) {
  Recording::Steps steps(run_.recording);
  const SteadyClock clock;
  double notified = clock.now();
  while (!stop.stop_requested()) {
    const std::optional<Recording::Step> step = steps.next();
    if (!step) break;
    take(*step);
    if (clock.now() - notified < kNews) continue;
    notified = clock.now();
    listener_.changed();
  }
  if (!stop.stop_requested()) listener_.changed();
}

void Playback::take(const Recording::Step& step) {
  const double part = std::max(run_.length(), 1e-3) / static_cast<double>(kEnvelope);
  const double at = std::floor((step.tick.time - run_.stretch.begin) / part);
  const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, double{kEnvelope - 1}));
  const auto force = static_cast<float>(message::eigen(step.tick.force).norm());
  const std::lock_guard lock(mutex_);
  envelope_[i] = std::max(envelope_[i], force);
  for (const message::Change& change : step.changes) {
    if (change.what != "field") continue;
    FieldOptions field;
    take_exact(Json::parse(change.value), field);
    fields_[step.hand].push_back({step.tick.time, field});
    const bool is_shown = !sought_ && step.tick.time <= run_.stretch.begin + moment_.time;
    if (is_shown && !moment_.playing) sought_ = moment_.time;  // with that field
    changed_.notify_all();
  }
}

}  // namespace palpate::app
