#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "tab/tab_run.hpp"
#include "viewer/bytes.hpp"

namespace palpate::tab {

using nlohmann::json;

/// Computing takes no time, on every machine.
struct Stopped final : Clock {
  [[nodiscard]] double now() const noexcept override { return 0; }
};

/// A page that speaks to what a tab runs, and what it heard. Its clock is what a test says.
struct HeardPage {
  using Make = std::function<std::unique_ptr<TabRun>(Outside, const Clock& stopwatch)>;

  /// `alone`: s before it comes.
  explicit HeardPage(const Make& make, double alone = 0)
      : tab(make({[this](std::string_view bytes, bool text) { take(std::string(bytes), text); },
                  [this](int code, const std::string&) { closed = code; },
                  [this](const std::string& name) { opened = name; },
                  [this](double unit) { opened_in = unit; }},
                 stopwatch)) {
    tab->run(now);
    run(alone);
    connect();
  }
  void connect() {
    tab->connect(now);
    say({{"type", "hello"}, {"token", "tab"}, {"points", 2000}});
  }
  void say(const json& message) { tab->receive(message.dump(), now); }
  /// A wake every 4 ms, as a browser does it.
  int run(double seconds) {
    int steps = 0;
    for (const double end = now + seconds; now < end - 1e-9;) steps += tab->run(now += 4e-3);
    return steps;
  }
  void take(std::string bytes, bool text) {
    if (text) {
      said.push_back(json::parse(bytes));
    } else if (test::u8(bytes, 0) == 1) {
      states.push_back(std::move(bytes));
    } else if (test::u8(bytes, 0) == 2) {
      ++clouds;
    } else if (test::u8(bytes, 0) == 4) {
      past = std::move(bytes);
      ++pasts;
    }
  }
  /// How many notices hold these words.
  [[nodiscard]] std::ptrdiff_t notices(const std::string& words) const {
    return std::ranges::count_if(said, [&](const json& message) {
      return message["type"] == "notice" &&
             std::string(message["text"]).find(words) != std::string::npos;
    });
  }
  [[nodiscard]] json last(const std::string& type) const {
    const auto found = std::find_if(said.rbegin(), said.rend(),
                                    [&](const json& message) { return message["type"] == type; });
    return found == said.rend() ? json() : *found;
  }
  [[nodiscard]] const std::string& state() const { return states.back(); }
  [[nodiscard]] Eigen::Vector3d force() const {
    return {test::f32(state(), 52), test::f32(state(), 56), test::f32(state(), 60)};
  }

  double now = 100;
  std::vector<json> said;
  std::vector<std::string> states;  // of all hands
  std::string past;
  int pasts = 0;
  int clouds = 0;
  int closed = 0;
  std::string opened;
  double opened_in = 0;
  Stopped stopwatch;
  std::unique_ptr<TabRun> tab;  // last: it speaks to all of the above
};

}  // namespace palpate::tab
