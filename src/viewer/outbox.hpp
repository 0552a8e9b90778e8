#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

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

}  // namespace palpate::viewer
