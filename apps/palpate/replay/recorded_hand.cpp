#include "apps/palpate/replay/recorded_hand.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recorded_messages.hpp"
#include "message/cdr.hpp"

namespace palpate::app {

namespace {

// s that are looked through for a step before a moment: most often there is one just before it.
constexpr std::array<double, 4> kBack{0.02, 0.5, 20, std::numeric_limits<double>::infinity()};

}  // namespace

RecordedDevice::RecordedDevice(const Json& info) {
  take_exact(info, info_);
}

std::uint64_t logged_at(double time, std::int64_t epoch) {
  const double ns = std::floor(1e9 * time);
  if (!(ns > -static_cast<double>(epoch))) return 0;
  return static_cast<std::uint64_t>(epoch + static_cast<std::int64_t>(ns));
}

RecordedHand::RecordedHand(const std::string& path, const bag::McapReader& reader,
                           const Json& setup, std::size_t hand)
    : reader_(path, reader.contents()), epoch_(setup.at("epoch_ns").get<std::int64_t>()) {
  const Json& json = setup.at("hands").at(hand);
  take_exact(json.at("options"), options_);
  topic_ = json.at("topic").get<std::string>() + "/tick";
  seek(-std::numeric_limits<double>::infinity());
}

void RecordedHand::seek(double time) {
  upcoming_.reset();
  reader_.choose([&](const bag::Channel& each) { return each.topic == topic_; },
                 logged_at(time, epoch_));
}

std::optional<ServoState> RecordedHand::next(double until) {
  bag::Message message;
  if (!upcoming_ && reader_.next(message)) {
    message::Tick tick;
    message::decode(message.data, tick);
    upcoming_ = state_of(tick, options_);
  }
  if (!upcoming_ || upcoming_->time > until) return std::nullopt;
  return std::exchange(upcoming_, std::nullopt);
}

std::optional<ServoState> RecordedHand::at(double time) {
  for (const double back : kBack) {
    seek(time - back);
    std::optional<ServoState> last;
    while (std::optional<ServoState> state = next(time)) last = state;
    if (last) return last;
  }
  return next();
}

}  // namespace palpate::app
