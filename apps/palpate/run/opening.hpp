#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::app {

/// The next run that a page wants, prepared on a thread of its own.
class Opening {
 public:
  /// A file that the page sent.
  struct Bytes {
    std::string bytes;
  };
  /// Sources as a command line names them.
  struct Sources {
    std::vector<std::string> sources;
  };
  /// The present run, with one of its sources read in another unit.
  struct OtherUnit {
    std::size_t source = 0;
    double metres = 1;
  };
  struct Wanted {
    std::string name;  ///< for people; of a file its own
    std::variant<Bytes, Sources, OtherUnit> what;
  };

  /// Reports what share of the file is read, 0 to 1; throws where nobody waits for it any more.
  using Notify = std::function<void(double share)>;

  /// Throws what is wrong with it.
  using Prepare = std::function<void(Wanted wanted, const Notify& notify)>;

  /// How it goes.
  struct News {
    enum class Kind { prepares, refused, prepared };
    Kind kind = Kind::prepares;
    std::string name;
    double share = 0;          ///< that is read; 1: its surface is being prepared
    std::string problem = {};  ///< of what was refused
  };

  explicit Opening(Prepare prepare) : prepare_(std::move(prepare)) {}
  /// Gives up what is being read. Waits for a surface that is being prepared, and reports it on
  /// standard error if that takes long.
  ~Opening();
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  /// Any thread; returns at once. @throws Error while there is another one.
  void begin(Wanted wanted);

  /// How the current file goes, its end once; unset: there is none. After `prepared` no other
  /// begins.
  [[nodiscard]] std::optional<News> look();

 private:
  void notify(double share);

  Prepare prepare_;
  std::mutex mutex_;
  std::string name_;  // empty: there is none
  std::atomic<double> share_ = 0;
  std::atomic<bool> given_up_ = false;
  std::future<void> work_;
};

}  // namespace palpate::app
