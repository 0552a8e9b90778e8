#pragma once

#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace palpate::app {

/// A file that a page sent for the next run, prepared on a thread of its own.
class Opening {
 public:
  /// Throws what is wrong with the file.
  using Prepare = std::function<void(const std::string& name, std::string bytes)>;

  /// How it goes.
  struct News {
    enum class Kind { prepares, refused, prepared };
    Kind kind = Kind::prepares;
    std::string name;
    double seconds = 0;        ///< since it began
    std::string problem = {};  ///< of what was refused
  };

  explicit Opening(Prepare prepare) : prepare_(std::move(prepare)) {}
  /// Waits for what is under way, and says so on standard error.
  ~Opening();
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  /// Any thread; returns at once. @throws Error while there is another one.
  void begin(const std::string& name, std::string bytes);

  /// What is new at `now`, s on any clock: every 5 s while it lasts, and once at its end. After
  /// `prepared` no other begins.
  [[nodiscard]] std::optional<News> look(double now);

 private:
  Prepare prepare_;
  std::mutex mutex_;
  std::string name_;  // empty: there is none
  std::optional<double> began_;
  double told_ = 0;
  std::future<void> work_;
};

}  // namespace palpate::app
