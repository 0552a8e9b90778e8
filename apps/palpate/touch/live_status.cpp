// The status line of a run in real time.
#include "apps/palpate/touch/live_status.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "apps/palpate/report/touch_report.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

namespace {

// Unlike fmt::print() it does not throw where nobody can read it.
void to_terminal(const std::string& text) {
  std::fputs(text.c_str(), stderr);
}

constexpr double kTerminalPeriod = 0.1;  // s
constexpr double kLinePeriod = 1;        // s
constexpr std::size_t kColumns = 80;     // of a terminal that does not report them

std::size_t columns() {
  winsize size{};
  const bool measured = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return measured ? size.ws_col : kColumns;
}

std::string hand_words(const HandMoment& moment) {
  if (!moment.silence.empty()) return moment.silence;
  std::string words =
      moment.ended
          ? "ended"
          : fmt::format("{:.2f} N  {:.0f} Hz, {:.0f} us (p99 {:.0f}), late p99 {:.2f} ms",
                        moment.force, moment.rate, 1e6 * moment.durations.computing.quantile(0.5),
                        1e6 * moment.durations.computing.quantile(0.99),
                        1e3 * moment.durations.lateness.quantile(0.99));
  const Wrench& wrench = moment.servo.wrench;
  if (!moment.ended && !wrench.torque.isZero(0))
    words += fmt::format("  torque {:.3f} N m", wrench.torque.norm());
  const Guard::State& guard = moment.servo.guard;
  if (moment.servo.clutched) words += "  clutch held: the hand moves without the tool";
  if (guard.fault != Guard::Fault::none) {
    words += fmt::format("  FAULT: {}", in_words(guard.fault));
  } else if (guard.notes != GuardNote::none) {
    words += "  " + in_words(guard);
  }
  return words;
}

// How old what is felt becomes before the next frame replaces it, s: as long after its stamp as
// people do not notice, and two frames, one of which may be lost.
double due_in(const StreamState& stream) {
  return kLateCloud + (stream.rate > 0 ? 2 / stream.rate : 0);
}

std::string stream_words(const StreamState& stream) {
  std::string words = stream.source;
  switch (stream.phase) {
    case StreamState::Phase::starting:
      return words + " waiting";
    case StreamState::Phase::ended:
      return words + " ended";
    case StreamState::Phase::stalled:
      words += " STALLED";
      break;
    case StreamState::Phase::failed:
      words += " FAILED";
      break;
    case StreamState::Phase::running:
      break;
  }
  words += fmt::format(" {:.1f} Hz, {:.0f} ms", stream.rate, 1e3 * stream.latency_mean);
  if (stream.phase == StreamState::Phase::running && stream.age > due_in(stream))
    words += fmt::format(", what is felt is {:.2f} s OLD", stream.age);
  if (stream.drops.total() > 0) words += fmt::format(", {} dropped", stream.drops.total());
  return words;
}

}  // namespace

std::string in_words(const LiveMoment& moment) {
  std::string words = fmt::format("{:.1f} s", moment.time);
  if (moment.hands.size() == 1) words += "  " + hand_words(moment.hands.front());
  if (moment.hands.size() > 1) {
    for (const HandMoment& hand : moment.hands) {
      words += fmt::format(" | {}: {}", hand.name, hand_words(hand));
    }
  }
  for (const StreamState& stream : moment.streams) words += " | " + stream_words(stream);
  if (moment.prepared < 1) words += fmt::format(" | preparing, {:.0f} %", 100 * moment.prepared);
  if (moment.robot) words += " | " + in_words(*moment.robot);
  return words;
}

std::string fitted(const std::string& line, std::size_t columns) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool begins = (static_cast<unsigned char>(line[i]) & 0xC0) != 0x80;
    if (begins && ++seen > columns) return line.substr(0, i);
  }
  return line;
}

LiveStatus::LiveStatus()
    : terminal_(isatty(STDERR_FILENO) != 0), next_(terminal_ ? kTerminalPeriod : kLinePeriod) {}

LiveStatus::~LiveStatus() {
  if (terminal_ && shown_) to_terminal("\r\033[K");
}

// Moments that were missed are not made up for.
void LiveStatus::show(const LiveMoment& moment) {
  next_ = std::max(next_, moment.time) + (terminal_ ? kTerminalPeriod : kLinePeriod);
  const std::string words = in_words(moment);
  if (terminal_) {
    to_terminal(fmt::format("\r{}\033[K", fitted(words, columns() - 1)));
  } else {
    to_terminal(words + "\n");
  }
  std::fflush(stderr);
  shown_ = true;
}

void LiveStatus::print(const std::string& words) {
  to_terminal(fmt::format("{}{}\n", terminal_ && shown_ ? "\r\033[K" : "", words));
}

}  // namespace palpate::app
