// Keeps the newest message of each topic for a client that reads slowly.
#include <algorithm>
#include <optional>
#include <utility>

#include "viewer/client_sessions.hpp"

namespace palpate::viewer {

void Outbox::put(Topic topic, Message message) {
  if (topic.kind == Topic::Kind::answer) {
    if (answers_.size() == kMostAnswers) answers_.pop_front();
    answers_.push_back(std::move(message));
    return;
  }
  const auto same = std::ranges::find(row_, topic, &Waiting::topic);
  if (same == row_.end()) {
    row_.push_back({topic, std::move(message)});
  } else {
    same->message = std::move(message);
  }
}

std::optional<Message> Outbox::take() {
  std::optional<Message> message;
  if (!answers_.empty()) {
    message = std::move(answers_.front());
    answers_.pop_front();
  } else if (!row_.empty()) {
    message = std::move(row_.front().message);
    row_.pop_front();
  }
  return message;
}

}  // namespace palpate::viewer
