// Numbers, colours and progress for people at a terminal.
#include "apps/palpate/cli/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <span>
#include <stop_token>
#include <utility>

namespace palpate::app {

namespace {

struct Unit {
  double size;
  const char* name;
};

// With three digits, in the largest unit that the value reaches.
std::string with_unit(double value, std::span<const Unit> units) {
  if (value == 0) return fmt::format("0 {}", units.front().name);
  const Unit* chosen = &units.back();
  for (const Unit& unit : units) {
    if (std::abs(value) < 0.9995 * unit.size) continue;
    chosen = &unit;
    break;
  }
  const double scaled = value / chosen->size;
  const int decimals = std::abs(scaled) >= 99.95 ? 0 : std::abs(scaled) >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}", scaled, decimals, chosen->name);
}

// Until the work is over or `patience` has passed; true: it is over.
bool over(const std::stop_token& stop, std::chrono::milliseconds patience) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait_for(lock, stop, patience, [] { return false; });
  return stop.stop_requested();
}

void wait(const std::stop_token& stop, const std::string& what) {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (over(stop, std::chrono::milliseconds(terminal ? 500 : 2000))) return;
  fmt::print(stderr, "{} ...{}", what, terminal ? "" : "\n");
  std::fflush(stderr);
  while (!over(stop, std::chrono::hours(1))) {
  }
  if (terminal) fmt::print(stderr, "\r\033[K");
}

/// Bytes of the control that UTF-8 text begins with; 0: with none. Those that turn the direction of
/// writing, too: they show a name as another.
std::size_t control_at(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto within = [](unsigned c, unsigned first, unsigned last) {
    return c - first <= last - first;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7f) return byte(0) == '\n' ? 0 : 1;
  if (byte(0) == 0xd8 && byte(1) == 0x9c) return 2;              // U+061C
  if (byte(0) == 0xc2 && within(byte(1), 0x80, 0x9f)) return 2;  // U+0080 to U+009F
  if (byte(0) != 0xe2) return 0;
  const bool marks =
      byte(1) == 0x80 && (within(byte(2), 0x8e, 0x8f) || within(byte(2), 0xaa, 0xae));
  return marks || (byte(1) == 0x81 && within(byte(2), 0xa6, 0xa9)) ? 3 : 0;
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string clean;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = control_at(text.substr(i));
    clean += length > 0 ? '?' : text[i];
    i += std::max<std::size_t>(length, 1);
  }
  return clean;
}

std::string grouped(std::size_t number) {
  if (number < 1000) return fmt::format("{}", number);
  return fmt::format("{} {:03}", grouped(number / 1000), number % 1000);
}

std::string length(double metres) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "m"}, {1e-3, "mm"}, {1e-6, "um"}}};
  // Kilometres only where metres have five digits.
  if (std::abs(metres) >= 1e4) return fmt::format("{:.1f} km", metres / 1000);
  return with_unit(metres, kUnits);
}

std::string energy(double joules) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "J"}, {1e-3, "mJ"}, {1e-6, "uJ"}}};
  return with_unit(joules, kUnits);
}

std::string duration(double seconds) {
  static constexpr std::array<Unit, 3> kUnits = {{{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}}};
  return with_unit(seconds, kUnits);
}

Style::Style(std::FILE* stream)
    : colored_(isatty(fileno(stream)) != 0 && std::getenv("NO_COLOR") == nullptr) {}

std::string Style::behind(int index, const std::string& text) const {
  return paint(fmt::format("48;5;{}", index).c_str(), text);
}

std::string Style::paint(const char* code, const std::string& text) const {
  return colored_ ? fmt::format("\033[{}m{}\033[0m", code, text) : text;
}

using namespace std::chrono_literals;

Progress::Progress(std::string what)
    : what_(std::move(what)),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + (terminal_ ? 100ms : 2000ms)) {}

Progress::~Progress() {
  if (terminal_ && shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(double done) {
  if (Clock::now() < next_) return;
  next_ = Clock::now() + (terminal_ ? 100ms : 5000ms);
  show(done);
}

void Progress::show(double done) {
  shown_ = true;
  const std::string share = fmt::format(": {:.0f} %", 100 * done);
  if (terminal_) {
    fmt::print(stderr, "\r{}{}\033[K", what_, share);
  } else {
    fmt::print(stderr, "{}{}\n", what_, share);
  }
  std::fflush(stderr);
}

Waiting::Waiting(std::string what)
    : thread_([what = std::move(what)](const std::stop_token& stop) { wait(stop, what); }) {}

}  // namespace palpate::app
