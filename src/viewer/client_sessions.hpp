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

#include "palpate/base/error.hpp"
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

/// Messages that wait to be sent to one client: at most one a topic, and kMostAnswers answers. Any
/// message but an answer is replaced by a newer one, never queued.
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
constexpr std::uint16_t kRestart = 1012;  // of IANA's registry
constexpr std::uint16_t kTryAgainLater = 1013;
}  // namespace close_code

/// State of one client, independent of its socket.
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

/// Who may connect, and what pages may see and do.
struct ClientSessionsOptions {
  std::string token;
  ViewerOptions::Limits limits = {};
  ViewerControls controls = {};  ///< `pause` and `reset` are set
  std::vector<DeviceLabel> devices;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of places that pages tell
  std::function<Welcome()> welcome;  ///< devices, settings and presets are filled in
};

/// All clients of the program: reads what they say, answers, remembers who holds which tool.
/// Knows neither sockets nor clocks; one thread uses it.
class ClientSessions {
 public:
  explicit ClientSessions(ClientSessionsOptions options)
      : options_(std::move(options)), recording_(options_.controls.recording) {
    holders_.resize(options_.devices.size(), nullptr);
  }

  /// A client outlives its leaving.
  void join(Session& session) { sessions_.push_back(&session); }
  /// Lets go of what the client held.
  void leave(Session& session);

  /// A message came at `now` (s).
  void receive(Session& session, std::string_view text, double now);
  /// A binary message: a page sends none.
  void receive_binary(Session& session, double now);
  /// Closes those who said no hello in time; lets go of tools whose holders have fallen silent.
  void check(double now);

  /// Sends to all clients that said hello.
  void send_to_all(Topic topic, const Message& message);
  void send_settings();
  void send(const Notice& notice);
  /// Tells the pages that the recording ended by itself.
  void end_record();
  /// Sends the time line's present moment if it has changed.
  void send_moment();
  /// Sends the envelope and the past of the time line.
  void send_time_line() { show_time_line(greeted()); }
  /// Sends to one client, unless it was sent these same bytes last.
  static void show(Session& session, Topic topic, const SharedBytes& bytes);

  [[nodiscard]] const ClientSessionsOptions& options() const { return options_; }
  /// Is the device's tool held by a page?
  [[nodiscard]] bool taken(std::size_t device) const { return holders_[device] != nullptr; }
  [[nodiscard]] std::vector<Session*> greeted() const;
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] std::uint64_t wrong_tokens() const { return wrong_tokens_; }
  [[nodiscard]] std::uint64_t turned_away() const { return turned_away_; }

 private:
  void act(Session& session, const Hello& hello);
  void act(Session& session, const Hand& hand);
  void act(Session& session, const Release& release);
  void act(Session& session, const Set& set);
  void act(Session& session, const Preset& preset);
  void act(Session& session, const Pause& pause);
  void act(Session& session, const Reset& reset);
  void act(Session& session, const Record& record);
  void act(Session& session, const Seek& seek);
  void act(Session& session, const Play& play);
  static void act(Session& session, const Points& points) { session.points = points.points; }
  void act(Session& session, const Ping& ping) { answer(session, pong_text(ping.id)); }
  static void act(Session&, const Unreadable& unreadable) { throw Error(unreadable.text); }

  void welcome(Session& session);
  void show_time_line(const std::vector<Session*>& sessions) const;
  void answer(Session& session, std::string text);
  void refuse(Session& session, std::string_view text, double now);
  void close(Session& session, std::uint16_t code, std::string reason);
  void release(std::size_t device);
  void lose(std::size_t device, std::string_view why);
  [[nodiscard]] std::vector<Setting> settings() const;

  ClientSessionsOptions options_;
  std::vector<Session*> sessions_;
  std::vector<Session*> holders_;           // of each device's tool
  std::string recording_;                   // the file, while one is recorded
  std::optional<TimeLine::Moment> moment_;  // that was told last
  std::uint64_t refused_ = 0;
  std::uint64_t wrong_tokens_ = 0;
  std::uint64_t turned_away_ = 0;
};

}  // namespace palpate::viewer
