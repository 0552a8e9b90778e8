#pragma once

#include <Eigen/Core>
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
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/viewer/viewer.hpp"
#include "viewer/messages.hpp"

namespace palpate::viewer {

using SharedBytes = std::shared_ptr<const std::string>;

/// Topic of a message: a newer message replaces an older one of the same topic, except answers.
struct Topic {
  enum class Kind : std::uint8_t {
    state,
    cloud,
    surface,
    settings,
    devices,
    sources,
    record,
    time,
    envelope,
    past,
    tool,
    answer
  };
  Kind kind = Kind::answer;
  std::size_t index = 0;  ///< of the device or source

  auto operator<=>(const Topic&) const = default;  // NOLINT(modernize-use-nullptr): its 0
};

struct Message {
  SharedBytes bytes;
  bool text = false;
};

inline Message text_message(std::string text) {
  return {std::make_shared<const std::string>(std::move(text)), true};
}
inline Message binary_message(std::string bytes) {
  return {std::make_shared<const std::string>(std::move(bytes)), false};
}

/// Messages that wait to be sent to one client: at most one a topic, and kMostAnswers answers. Any
/// message but an answer is replaced by a newer one, never queued.
class Outbox {
 public:
  static constexpr std::size_t kMostAnswers = 32;

  /// A replaced message leaves its slot in the row to the newer one, so every topic comes to its
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
constexpr std::uint16_t kRestart = 1012;  // of IANA's registry
constexpr std::uint16_t kTryAgainLater = 1013;
}  // namespace close_code

/// State of one client, independent of its socket.
struct Session {
  Session(const ViewerOptions::Limits& limits, double time)
      : opened(time),
        messages(limits.messages, 1),
        refusals(limits.refusals - 1, limits.refusal_time) {}

  void send(Topic topic, Message message) {
    outbox.put(topic, std::move(message));
    if (wake) wake();
  }
  void answer(std::string text) { send({Topic::Kind::answer}, text_message(std::move(text))); }
  /// Sends these bytes, unless it was sent the same of that topic last.
  void show(Topic topic, const SharedBytes& bytes) {
    if (std::exchange(shown[topic], bytes) != bytes) send(topic, {bytes, false});
  }
  void lose(std::size_t tool, std::string_view why) {
    lost.insert(tool);
    answer(lost_text(tool, why));
  }
  void close(std::uint16_t code, std::string reason) {
    closing = Closing{code, std::move(reason)};
    if (wake) wake();
  }

  double opened;         ///< s
  bool greeted = false;  ///< said hello with the token
  std::size_t points = 0;
  double received = 0;         ///< time of its last message, s
  std::set<std::size_t> lost;  ///< lost tools that it has not released yet
  Outbox outbox;
  RateWindow messages;
  RateWindow refusals;
  std::optional<Closing> closing;      ///< once what is in the outbox is sent
  std::map<Topic, SharedBytes> shown;  ///< clouds and surfaces that were put into the outbox last
  std::function<void()> wake = {};     ///< there is something in the outbox, or `closing` is set
};

/// Who may connect, and what pages may see and do.
struct ClientSessionsOptions {
  std::string token;
  ViewerOptions::Limits limits = {};
  ViewerControls controls = {};  ///< `pause` and `reset` are set
  std::vector<DeviceLabel> devices;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of positions that pages send
  std::function<Welcome()> welcome;  ///< devices, settings and presets are filled in
};

/// Does what pages wish of tools. Remembers which client holds which tool: the last one that moved
/// it, until it releases the tool, leaves or falls silent.
class ToolHolders {
 public:
  /// `options` outlive it.
  explicit ToolHolders(const ClientSessionsOptions& options)
      : options_(options), holders_(options.devices.size(), nullptr) {}

  [[nodiscard]] bool taken(std::size_t device) const { return holders_[device] != nullptr; }
  // @throws Error that explains why a page cannot do that.
  void move(Session& session, const Hand& hand);
  void release(Session& session, const Release& wish);
  void reset(const Reset& wish) const;
  /// Releases all tools of a client that is gone.
  void leave(const Session& session);
  /// Releases what silent clients hold at `now` (s), and notifies them.
  void check(double now);

 private:
  void let_go(std::size_t device);

  const ClientSessionsOptions& options_;
  std::vector<Session*> holders_;  // of each device's tool
};

/// All clients of the program: reads what they send and answers. Depends on neither sockets nor
/// clocks; one thread uses it.
class ClientSessions {
 public:
  explicit ClientSessions(ClientSessionsOptions options)
      : options_(std::move(options)), tools_(options_), recording_(options_.controls.recording) {}
  ClientSessions(const ClientSessions&) = delete;
  ClientSessions& operator=(const ClientSessions&) = delete;

  /// A client outlives its leaving.
  void join(Session& session) { sessions_.push_back(&session); }
  /// Releases the tools that the client held.
  void leave(Session& session) {
    std::erase(sessions_, &session);
    tools_.leave(session);
  }

  /// A message came at `now` (s).
  void receive(Session& session, std::string_view text, double now);
  /// Notifies a client that its message was refused; closes it after too many of them.
  void refuse(Session& session, std::string_view why, double now);
  /// Closes those who said no hello in time; lets go of tools whose holders have fallen silent.
  void check(double now);

  /// Sends to all clients that said hello.
  void send_to_all(Topic topic, const Message& message);
  void send_settings();
  void send(const Notice& notice);
  /// Notifies the pages that the recording ended by itself.
  void end_record();
  /// Sends the time line's present moment if it has changed.
  void send_moment();
  /// Sends the envelope and the past of the time line, which takes the place of what pages knew.
  void send_time_line();
  /// Sends the envelope alone.
  void send_envelope();

  [[nodiscard]] const ClientSessionsOptions& options() const { return options_; }
  /// Is the device's tool held by a page?
  [[nodiscard]] bool taken(std::size_t device) const { return tools_.taken(device); }
  [[nodiscard]] std::vector<Session*> greeted() const;
  /// What was turned away, forbidden and refused; the rest is 0.
  [[nodiscard]] const Viewer::Counts& counts() const { return counts_; }

 private:
  void act(Session& session, const ClientMessage& message);
  void greet(Session& session, const Hello& hello);
  void record(bool on);

  ClientSessionsOptions options_;
  ToolHolders tools_;
  std::vector<Session*> sessions_;
  std::string recording_;                   // the file, while one is recorded
  std::optional<TimeLine::Moment> moment_;  // that was sent last
  Viewer::Counts counts_;
};

}  // namespace palpate::viewer
