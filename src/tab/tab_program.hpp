// Declares the program that runs in a tab of a browser.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "palpate/base/clock.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::tab {

/// What is touched.
struct Touched {
  std::string name;  ///< for people
  PointCloud cloud;
};

/// A cloud that a formula makes, by its name: "synthetic:torus".
/// @throws Error that lists the names.
[[nodiscard]] Touched synthetic(const std::string& name);

/// The cloud in the bytes of a file of that name, by read_cloud_bytes(). @throws Error as it does.
[[nodiscard]] Touched of_file(std::span<const std::byte> bytes, const std::string& name);

/// What is wrong, for people; of memory that did not suffice for what has that name, too.
[[nodiscard]] std::string words_of(const std::exception& error, const std::string& name);

/// Whom the program calls.
struct Outside {
  /// A message to the page (docs/viewer_protocol.md).
  std::function<void(std::string_view bytes, bool text)> say;
  /// The connection is to be closed: a code of RFC 6455, and why.
  std::function<void(int code, const std::string& why)> close;
  /// The person wants another scene: "synthetic:room".
  std::function<void(const std::string& name)> open;
};

/// A page's program without sockets, threads and a clock of its own: a cloud, and one simulated
/// hand that the page may take. Device, hand and servo are simulated together, so what is felt does
/// not depend on how often run() is called.
///
/// Times in s, on one clock, which never goes back; a second clock measures how long computing
/// takes, which decides how seldom pictures come, and nothing else. One thread uses it.
class TabProgram {
 public:
  /// Prepares the cloud. `news`: said to the first page; empty: nothing. `stopwatch` outlives it.
  /// @throws Error as preparing does, and where there is nothing to touch.
  TabProgram(Touched touched, Outside outside, const Clock& stopwatch, std::string news = {});
  ~TabProgram();
  TabProgram(const TabProgram&) = delete;
  TabProgram& operator=(const TabProgram&) = delete;

  /// A page is there; one that was is gone.
  void connect(double now);
  /// The page's message.
  void receive(std::string_view text, double now);
  /// Steps up to `now`, and tells the page. What is later than kMostLate is left out. The number of
  /// steps.
  int run(double now);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::tab
