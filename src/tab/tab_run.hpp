// Declares what the worker of a tab runs.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "palpate/base/clock.hpp"

namespace palpate::tab {

/// The bytes of a file that a person gave; null: there is none.
struct FileBytes {
  std::shared_ptr<const std::byte[]> bytes;
  std::size_t size = 0;
  double unit = 0;  ///< metres a unit of the file; 0: the likely one
};

/// Whom a run calls.
struct Outside {
  /// A message to the page (docs/viewer_protocol.md).
  std::function<void(std::string_view bytes, bool text)> say;
  /// The connection is to be closed: a code of RFC 6455, and why.
  std::function<void(int code, const std::string& why)> close;
  /// The person wants another scene: "synthetic:room".
  std::function<void(const std::string& name)> open;
  /// The person wants the same file again, in another unit, metres.
  std::function<void(double unit)> open_again;
};

/// A page's program without sockets, threads and a clock of its own. Times in s, on one clock,
/// which never goes back; a second clock measures how long computing takes, which decides how
/// seldom pictures come, and nothing else. One thread uses it.
class TabRun {
 public:
  TabRun() = default;
  virtual ~TabRun() = default;
  TabRun(const TabRun&) = delete;
  TabRun& operator=(const TabRun&) = delete;

  /// A page is there; one that was is gone.
  virtual void connect(double now) = 0;
  /// The page's message.
  virtual void receive(std::string_view text, double now) = 0;
  /// Goes on to `now`, and tells the page. The number of steps that were computed.
  virtual int run(double now) = 0;
};

/// What is to be touched: the file of that name, a recording to be replayed among them, or, where
/// there is none, a synthetic cloud. `news`: said to the first page; empty: nothing. `stopwatch`
/// outlives it. @throws Error as reading and preparing do, and where there is nothing to touch.
[[nodiscard]] std::unique_ptr<TabRun> open_run(const std::string& name, FileBytes file,
                                               Outside outside, const Clock& stopwatch,
                                               std::string news = {});

/// What is wrong, for people; of memory that did not suffice for what has that name, too.
[[nodiscard]] std::string words_of(const std::exception& error, const std::string& name);

}  // namespace palpate::tab
