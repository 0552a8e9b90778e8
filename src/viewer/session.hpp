#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "palpate/viewer/viewer.hpp"

namespace palpate::viewer {

using SharedBytes = std::shared_ptr<const std::string>;

/// What a message is of: a newer one of the same topic takes an older one's place.
struct Topic {
  enum class Kind : std::uint8_t {
    state,
    cloud,
    surface,
    settings,
    devices,
    sources,
    record,
    answer
  };
  Kind kind = Kind::answer;
  std::size_t index = 0;  ///< of the device or source

  auto operator<=>(const Topic&) const = default;
};

struct Message {
  SharedBytes bytes;
  bool text = false;
};

/// What waits to be sent to one client. Never more than one message a topic and kMostAnswers
/// answers (which all count, up to there): what a client does not take is replaced, never queued.
class Outbox {
 public:
  static constexpr std::size_t kMostAnswers = 32;

  /// A replaced message leaves its place in the row to the newer one, so every topic comes to its
  /// turn. Beyond kMostAnswers the oldest answer is left out.
  void put(Topic topic, Message message);

  /// The message that has waited longest; none: nothing waits. Answers go first.
  [[nodiscard]] std::optional<Message> take();

  [[nodiscard]] bool empty() const { return answers_.empty() && row_.empty(); }
  [[nodiscard]] std::size_t size() const { return answers_.size() + row_.size(); }

 private:
  struct Waiting {
    Topic topic;
    Message message;
  };
  std::deque<Message> answers_;
  std::deque<Waiting> row_;
};

/// Are there more than `most` events in a stretch of time? Stretches follow one another, so twice
/// as many may fall into one that lies across two.
class RateWindow {
 public:
  RateWindow(int most, double length) noexcept : most_(most), length_(length) {}

  /// An event at `now` (s). True: it is one too many.
  bool exceeded(double now) noexcept {
    if (!(now - begin_ < length_)) {
      begin_ = now;
      count_ = 0;
    }
    if (count_ > most_) return true;
    return ++count_ > most_;
  }

 private:
  int most_;
  double length_;
  double begin_ = -1e300;
  int count_ = 0;
};

/// Why a socket is to be closed: a code of RFC 6455 and words.
struct Closing {
  std::uint16_t code = 0;
  std::string reason;
};

namespace close_code {
constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kPolicy = 1008;
constexpr std::uint16_t kTryAgainLater = 1013;
}  // namespace close_code

/// One socket, as those who know nothing of sockets see it.
struct Session {
  Session(const ViewerOptions::Limits& limits, double time)
      : opened(time),
        messages(limits.messages, 1),
        refusals(limits.refusals - 1, limits.refusal_time) {}

  double opened;         ///< s
  bool greeted = false;  ///< said hello with the token
  std::size_t points = 0;
  double heard = 0;            ///< when it said something last, s
  std::set<std::size_t> lost;  ///< tools that it does not know yet to be lost
  Outbox outbox;
  RateWindow messages;
  RateWindow refusals;
  std::optional<Closing> closing;      ///< once what is in the outbox is sent
  std::map<Topic, SharedBytes> shown;  ///< clouds and surfaces that were put into the outbox last
  std::function<void()> wake = {};     ///< there is something in the outbox, or `closing` is set
};

}  // namespace palpate::viewer
