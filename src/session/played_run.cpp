// Plays a recorded run, or shows it at any moment.
#include "session/played_run.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iterator>
#include <utility>

#include "message/transforms.hpp"
#include "session/options_json.hpp"

namespace palpate::session {

namespace {

// Does this with each hand. A damaged step of one leaves the others where they belong. The first
// damage; null: none.
std::exception_ptr damage_of(auto& hands, const std::function<void(ShownHand&)>& act) {
  std::exception_ptr damage;
  for (ShownHand& hand : hands) {
    try {
      act(hand);
    } catch (...) {
      if (!damage) damage = std::current_exception();
    }
  }
  return damage;
}

}  // namespace

PlayedRun::PlayedRun(bag::RandomFile file, std::function<void()> called)
    : run_(std::move(file)),
      steps_(run_.recording),
      called_(std::move(called)),
      envelope_(kEnvelope, 0.0F),
      pasts_(run_.hands.size()) {
  sought_ = moment_.time = run_.first_surface();
  for (ShownHand& hand : run_.hands) {
    hand.seek(run_.stretch.begin + moment_.time);
    fields_.push_back({FieldChange{run_.stretch.begin, hand.servo().field()}});
  }
}

std::vector<Servo*> PlayedRun::servos() {
  std::vector<Servo*> servos;
  for (ShownHand& hand : run_.hands) servos.push_back(&hand.servo());
  return servos;
}

PlayedRun::TimeLine PlayedRun::time_line() {
  const auto locked = [this](const auto& copy) {
    return [this, copy](auto... which) {
      const std::lock_guard lock(mutex_);
      return copy(which...);
    };
  };
  TimeLine line;
  line.length = run_.length();
  line.moment = [this] { return moment(); };
  line.seek = [this](double time) { seek(time); };
  line.play = [this](bool on, double speed) { play(on, speed); };
  line.envelope = locked([this] { return envelope_; });
  line.past = locked([this](std::size_t hand) { return pasts_[hand]; });
  return line;
}

std::vector<ViewerOptions::Stream> PlayedRun::streams() const {
  std::vector<ViewerOptions::Stream> streams;
  for (const ShownSource& source : run_.sources) {
    if (source.lives()) streams.push_back(source.stream());
  }
  return streams;
}

ViewerOptions PlayedRun::viewer_options() {
  ViewerOptions options;
  options.scene = std::filesystem::path(run_.recording.path()).filename();
  options.streams = [this] { return streams(); };
  if (!run_.recording.in_picture_axes()) return options;
  options.eye = run_.scene.source(0).pose().translation();
  options.up = -Eigen::Vector3d::UnitY();
  return options;
}

bool PlayedRun::has_cameras() const {
  return std::ranges::any_of(run_.sources, &ShownSource::lives);
}

PlayedRun::TimeLine::Moment PlayedRun::moment() const {
  const std::lock_guard lock(mutex_);
  return moment_;
}

bool PlayedRun::is_sought() const {
  const std::lock_guard lock(mutex_);
  return sought_.has_value();
}

void PlayedRun::seek(double time) {
  {
    const std::lock_guard lock(mutex_);
    sought_ = moment_.time = std::clamp(time, 0.0, run_.length());
  }
  called_();
}

void PlayedRun::play(bool on, double speed) {
  {
    const std::lock_guard lock(mutex_);
    if (on && !moment_.playing && moment_.time >= run_.length()) sought_ = moment_.time = 0;
    moment_.playing = on;
    moment_.speed = speed;
  }
  called_();
}

bool PlayedRun::show(double elapsed, const std::function<bool()>& cancelled,
                     const Complain& complain) {
  std::optional<double> sought;
  double before = 0;
  {
    const std::lock_guard lock(mutex_);
    sought = std::exchange(sought_, std::nullopt);
    before = moment_.time;
  }
  try {
    sought ? jump(*sought, cancelled) : advance(elapsed);
  } catch (const std::exception& error) {
    complain(error);
    const std::lock_guard lock(mutex_);
    if (!sought_) {  // else somebody chose another moment meanwhile
      moment_.playing = false;
      moment_.time = before;
    }
  }
  return sought.has_value();
}

void PlayedRun::jump(double time, const std::function<bool()>& cancelled) {
  const auto damage =
      damage_of(run_.hands, [&](ShownHand& hand) { hand.seek(run_.stretch.begin + time); });
  show_fields(run_.stretch.begin + time);
  for (std::size_t i = 0; i < run_.hands.size(); ++i) {
    std::vector<TimeLine::Force> past =
        run_.hands[i].past(kPast, [&] { return is_sought() || cancelled(); });
    const std::lock_guard lock(mutex_);
    pasts_[i] = std::move(past);
  }
  if (damage) std::rethrow_exception(damage);
}

void PlayedRun::advance(double elapsed) {
  double time = 0;
  {
    const std::lock_guard lock(mutex_);
    if (sought_ || !moment_.playing) return;
    time = moment_.time = std::min(moment_.time + elapsed * moment_.speed, run_.length());
    moment_.playing = time < run_.length();
  }
  const auto damage =
      damage_of(run_.hands, [&](ShownHand& hand) { hand.advance(run_.stretch.begin + time); });
  show_fields(run_.stretch.begin + time);
  if (damage) std::rethrow_exception(damage);
}

// The surface around a tool is that of the field which its hand felt.
void PlayedRun::show_fields(double time) {
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

double PlayedRun::show_frames(const Complain& complain) {
  const double time = moment().time;
  for (ShownSource& source : run_.sources) {
    if (!source.lives()) continue;
    try {
      source.show(run_.stretch.begin + time);
    } catch (const std::exception& error) {
      complain(error);
    }
  }
  return time;
}

bool PlayedRun::read_forces(std::size_t steps) {
  for (; steps > 0; --steps) {
    const std::optional<Recording::Step> step = steps_.next();
    if (!step) return false;
    take(*step);
  }
  return true;
}

void PlayedRun::take(const Recording::Step& step) {
  const double part = std::max(run_.length(), 1e-3) / static_cast<double>(kEnvelope);
  const double at = std::floor((step.tick.time - run_.stretch.begin) / part);
  const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, double{kEnvelope - 1}));
  const auto force = static_cast<float>(message::eigen(step.tick.force).norm());
  {
    const std::lock_guard lock(mutex_);
    envelope_[i] = std::max(envelope_[i], force);
  }
  for (const message::Change& change : step.changes) {
    if (change.what != "field") continue;
    FieldChange field{step.tick.time, {}};
    take_exact(Json::parse(change.value), field.field);
    if (take_field(step.hand, field)) called_();
  }
}

// True: what is shown is shown again, with that field.
bool PlayedRun::take_field(std::size_t hand, const FieldChange& change) {
  const std::lock_guard lock(mutex_);
  fields_[hand].push_back(change);
  const bool is_shown = !sought_ && change.time <= run_.stretch.begin + moment_.time;
  if (!is_shown || moment_.playing) return false;
  sought_ = moment_.time;
  return true;
}

}  // namespace palpate::session
