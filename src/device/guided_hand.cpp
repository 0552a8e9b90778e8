#include "palpate/device/guided_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/device/scripted.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

void require(bool good, const char* name, double value, const char* range) {
  if (!good || !std::isfinite(value)) {
    throw Error(fmt::format("guided hand: {} = {} is out of range: give {}", name, value, range));
  }
}

void validate(const GuidedHandOptions& o) {
  require(o.speed > 0, "speed", o.speed, "a positive speed in m/s");
  require(o.silence > 0, "silence", o.silence, "a positive time in seconds");
  require(o.letting_go > 0, "letting_go", o.letting_go, "a positive time in seconds");
  require(o.return_after >= 0, "return_after", o.return_after, "0 or more seconds");
}

}  // namespace

GuidedHand::GuidedHand(const RemoteHand& remote, Trajectory way, const GuidedHandOptions& options)
    : remote_(remote), options_(options) {
  validate(options_);
  if (!way.empty()) check(way);
  way_ = Playback(std::move(way));
}

HandWish GuidedHand::wanted(double time, const Vector3d& position) noexcept {
  if (!started_) begin(time, position);
  listen(time);
  choose(time);
  go_on(time, position);
  time_ = time;
  return wish_;
}

void GuidedHand::begin(double time, const Vector3d& position) noexcept {
  started_ = true;
  time_ = time;
  heard_ = time;
  wish_.position = position;
  if (way_.empty()) return;
  wish_.position = way_.front().position;
  way_time_ = way_.front().time;
  mode_ = Mode::playing;
}

// Words are dated by when they are heard: no clock but the device's own counts.
void GuidedHand::listen(double time) noexcept {
  const std::uint64_t generation = remote_.generation();
  if (generation == generation_) return;
  const std::optional<HandWord> word = remote_.look();
  if (!word) return;
  generation_ = generation;
  heard_ = time;
  const bool moved = word->poses != word_.poses;
  word_ = *word;
  if (!word_.held || !moved) return;
  if (mode_ != Mode::following) glide_.rest(wish_.position, time);
  glide_.go(word_.pose.wish.position, word_.pose.stamp, time);
}

void GuidedHand::choose(double time) noexcept {
  const bool held = word_.held && time - heard_ <= options_.silence;
  if (held) {
    mode_ = Mode::following;
  } else if (mode_ == Mode::following) {
    mode_ = Mode::letting_go;
    let_go_ = time;
  } else if (mode_ == Mode::letting_go && !way_.empty() &&
             time - let_go_ >= options_.return_after) {
    mode_ = Mode::returning;
  }
  wish_.buttons = held ? word_.pose.wish.buttons : 0;
  taken_.store(held);
}

void GuidedHand::go_on(double time, const Vector3d& position) noexcept {
  const double dt = time - time_;
  switch (mode_) {
    case Mode::following:
      approach(glide_.at(time), dt);
      return;
    case Mode::letting_go:
      approach(
          wish_.position + std::min(1.0, dt / options_.letting_go) * (position - wish_.position),
          dt);
      return;
    case Mode::returning:
      approach(way_.at(way_time_), dt);
      if (wish_.position == way_.at(way_time_)) mode_ = Mode::playing;
      return;
    case Mode::playing:
      play(dt);
      return;
  }
}

void GuidedHand::play(double dt) noexcept {
  way_time_ += dt;
  wish_.position = way_.at(way_time_);
  if (way_time_ < way_.end()) return;
  way_.rewind();
  way_time_ = way_.front().time;
  mode_ = Mode::returning;
}

void GuidedHand::approach(const Vector3d& goal, double dt) noexcept {
  const Vector3d way = goal - wish_.position;
  const double length = way.norm();
  const double reach = options_.speed * dt;
  if (length <= reach) {
    wish_.position = goal;
  } else {
    wish_.position += reach / length * way;
  }
}

}  // namespace palpate
