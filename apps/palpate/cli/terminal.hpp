#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace palpate::app {

/// `text`, UTF-8, without what would move a terminal's cursor, colour it or turn the direction of
/// writing: control characters but line ends become '?'. File names and what is in files are not
/// ours.
[[nodiscard]] std::string without_controls(std::string_view text);

// Numbers for people.

/// "12 345 678".
[[nodiscard]] std::string grouped(std::size_t number);

/// A length in metres with a fitting unit: "2.54 mm", "0.8 um", "1.42 km".
[[nodiscard]] std::string length(double metres);

/// An energy in joules in the same form: "-12.3 mJ".
[[nodiscard]] std::string energy(double joules);

/// A time in seconds in the same form: "0.35 s", "12 ms".
[[nodiscard]] std::string duration(double seconds);

/// Quantile by nearest rank: the smallest of `sorted` that is at least as large as a share (0 to 1)
/// of them; 0 if there are none.
template <class Number>
[[nodiscard]] double quantile(const std::vector<Number>& sorted, double share) {
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return static_cast<double>(sorted[std::max<std::size_t>(rank, 1) - 1]);
}

/// Emphasis on a terminal, nothing elsewhere or where NO_COLOR is set.
class Style {
 public:
  explicit Style(std::FILE* stream);
  [[nodiscard]] std::string heading(const std::string& text) const { return paint("1;36", text); }
  [[nodiscard]] std::string warning(const std::string& text) const { return paint("33", text); }
  [[nodiscard]] std::string error(const std::string& text) const { return paint("1;31", text); }
  [[nodiscard]] bool colored() const { return colored_; }
  /// Colour `index` (0-255) of the terminal's palette behind `text`.
  [[nodiscard]] std::string behind(int index, const std::string& text) const;

 private:
  [[nodiscard]] std::string paint(const char* code, const std::string& text) const;
  bool colored_;
};

/// Reports on standard error how far something is: in one line that is rewritten on a terminal; in
/// lines of their own, after two seconds and then every five, elsewhere.
class Progress {
 public:
  /// `what` is being done: "reading table.ply".
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done`: 0 to 1.
  void update(double done);

  /// Calls update(); this has to outlive it.
  [[nodiscard]] std::function<void(double)> updater() {
    return [this](double done) { update(done); };
  }

 private:
  using Clock = std::chrono::steady_clock;
  void show(double done);

  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point next_;
};

/// Reports on standard error that something of unknown progress is going on, once it has
/// taken a while: half a second on a terminal, where the line vanishes at the end, else two.
class Waiting {
 public:
  explicit Waiting(std::string what);

 private:
  std::jthread thread_;  // joins at the end of the work
};

}  // namespace palpate::app
