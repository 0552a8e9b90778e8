#include "apps/palpate/replay/player.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <map>
#include <utility>

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/replay/replayed_run.hpp"
#include "message/transforms.hpp"

namespace palpate::app {

namespace {

constexpr std::chrono::milliseconds kPicture{8};
constexpr std::chrono::milliseconds kFrame{25};
constexpr double kNews = 0.5;  // s between two envelopes, while the file is read

}  // namespace

Player::Player(const std::string& path)
    : path_(path),
      reader_(path),
      setup_(recorded_setup(reader_, path)),
      stretch_(stretch_of(path, reader_, setup_)),
      envelope_(kEnvelope, 0.0F),
      pasts_(setup_.at("hands").size()),
      fields_(pasts_.size()) {
  for (std::size_t i = 0; i < setup_.at("sources").size(); ++i) {
    sources_.emplace_back(path, reader_, setup_, i, scene_);
  }
  for (std::size_t i = 0; i < pasts_.size(); ++i) {
    hands_.emplace_back(path, reader_, setup_, i, scene_);
    hands_.back().seek(stretch_.begin);
    fields_[i].push_back({stretch_.begin, hands_.back().servo().field()});
  }
}

Player::~Player() {
  stop();
}

std::vector<Servo*> Player::servos() {
  std::vector<Servo*> servos;
  for (ShownHand& hand : hands_) servos.push_back(&hand.servo());
  return servos;
}

void Player::start(Listener listener) {
  listener_ = std::move(listener);
  const auto run = [this](void (Player::*work)(const std::stop_token&)) {
    threads_.emplace_back(
        [this, work](const std::stop_token& stop) { guard([&] { (this->*work)(stop); }); });
  };
  run(&Player::show_steps);
  run(&Player::read_forces);
  const bool live = std::ranges::any_of(sources_, &ShownSource::lives);
  if (live) run(&Player::show_frames);
}

void Player::stop() {
  threads_.clear();
}

// What is damaged ends its thread alone.
void Player::guard(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    listener_.complain(error.what());
  }
}

Player::TimeLine::Moment Player::moment() const {
  const std::lock_guard lock(mutex_);
  return moment_;
}

void Player::seek(double time) {
  {
    const std::lock_guard lock(mutex_);
    sought_ = moment_.time = std::clamp(time, 0.0, length());
  }
  changed_.notify_all();
}

void Player::play(bool on, double speed) {
  {
    const std::lock_guard lock(mutex_);
    if (on && !moment_.playing && moment_.time >= length()) sought_ = moment_.time = 0;
    moment_.playing = on;
    moment_.speed = speed;
  }
  changed_.notify_all();
}

std::vector<float> Player::envelope() const {
  const std::lock_guard lock(mutex_);
  return envelope_;
}

std::vector<Player::TimeLine::Force> Player::past(std::size_t hand) const {
  const std::lock_guard lock(mutex_);
  return pasts_[hand];
}

std::vector<ViewerOptions::Stream> Player::streams() const {
  std::vector<ViewerOptions::Stream> streams;
  for (const ShownSource& source : sources_) {
    if (source.lives()) streams.push_back(source.stream());
  }
  return streams;
}

void Player::show_steps(const std::stop_token& stop) {
  double looked = clock_.now();
  while (!stop.stop_requested()) {
    std::optional<double> sought;
    {
      std::unique_lock lock(mutex_);
      const auto called = [this] { return sought_.has_value(); };
      if (moment_.playing) {
        changed_.wait_for(lock, stop, kPicture, called);
      } else {
        changed_.wait(lock, stop, [&] { return called() || moment_.playing; });
        looked = clock_.now();
      }
      sought = std::exchange(sought_, std::nullopt);
    }
    if (sought) jump(*sought, stop);
    const double now = clock_.now();
    if (!sought) advance(now - looked);
    looked = now;
  }
}

void Player::jump(double time, const std::stop_token& stop) {
  for (ShownHand& hand : hands_) hand.seek(stretch_.begin + time);
  show_fields(stretch_.begin + time);
  const auto cancelled = [&] {
    const std::lock_guard lock(mutex_);
    return sought_.has_value() || stop.stop_requested();
  };
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    std::vector<TimeLine::Force> past = hands_[i].past(kPast, cancelled);
    const std::lock_guard lock(mutex_);
    pasts_[i] = std::move(past);
  }
  if (!cancelled()) listener_.changed();
}

void Player::advance(double elapsed) {
  double time = 0;
  {
    const std::lock_guard lock(mutex_);
    if (sought_ || !moment_.playing) return;
    time = moment_.time = std::min(moment_.time + elapsed * moment_.speed, length());
    moment_.playing = time < length();
  }
  for (ShownHand& hand : hands_) hand.advance(stretch_.begin + time);
  show_fields(stretch_.begin + time);
}

// The surface around a tool is that of the field which its hand felt.
void Player::show_fields(double time) {
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    FieldOptions field;
    {
      const std::lock_guard lock(mutex_);
      const auto after = std::ranges::upper_bound(fields_[i], time, {}, &FieldChange::time);
      field = (after == fields_[i].begin() ? after : std::prev(after))->field;
    }
    if (field != hands_[i].servo().field()) hands_[i].servo().set_field(field);
  }
}

void Player::show_frames(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const double time = moment().time;
    for (ShownSource& source : sources_) {
      if (source.lives()) guard([&] { source.show(stretch_.begin + time); });
    }
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, kFrame, [] { return false; });
    changed_.wait(lock, stop, [&] { return moment_.time != time; });
  }
}

void Player::read_forces(const std::stop_token& stop) {
  std::map<std::string, std::size_t> topics;  // with the hand
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const auto topic = setup_.at("hands").at(i).at("topic").get<std::string>();
    topics[topic + "/tick"] = topics[topic + "/change"] = i;
  }
  bag::McapReader reader(path_, reader_.contents());
  reader.choose([&](const bag::Channel& each) { return topics.contains(each.topic); });
  double told = clock_.now();
  for (bag::Message message; !stop.stop_requested() && reader.next(message);) {
    const bag::Channel& channel = reader.channel_of(message);
    if (channel.topic.ends_with("/tick")) {
      message::Tick tick;
      message::decode(message.data, tick);
      take(tick);
    } else {
      message::Change change;
      message::decode(message.data, change);
      take(topics.at(channel.topic), change);
    }
    if (clock_.now() - told < kNews) continue;
    told = clock_.now();
    listener_.changed();
  }
  if (!stop.stop_requested()) listener_.changed();
}

void Player::take(const message::Tick& tick) {
  const double part = std::max(length(), 1e-3) / static_cast<double>(kEnvelope);
  const double at = std::floor((tick.time - stretch_.begin) / part);
  const auto i = static_cast<std::size_t>(std::clamp(at, 0.0, double{kEnvelope - 1}));
  const auto force = static_cast<float>(message::eigen(tick.force).norm());
  const std::lock_guard lock(mutex_);
  envelope_[i] = std::max(envelope_[i], force);
}

void Player::take(std::size_t hand, const message::Change& change) {
  if (change.what != "field") return;
  FieldChange field;
  const auto epoch = setup_.at("epoch_ns").get<std::int64_t>();
  const std::int64_t stamp =
      std::int64_t{1'000'000'000} * change.header.stamp.sec + change.header.stamp.nanosec;
  field.time = 1e-9 * static_cast<double>(stamp - epoch) - 1e-6;  // before its step
  take_exact(Json::parse(change.value), field.field);
  const std::lock_guard lock(mutex_);
  fields_[hand].push_back(field);
}

}  // namespace palpate::app
