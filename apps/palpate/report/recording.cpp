#include "apps/palpate/report/recording.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "apps/palpate/cli/output.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

Recording::~Recording() {
  try {
    end();
  } catch (const Error& error) {
    fmt::print(stderr, "the page's recording was lost: {}\n", error.what());
  }
}

std::string Recording::record(bool on) {
  const std::lock_guard lock(mutex_);
  if (!on) return end();
  if (logs_.empty()) begin();
  return name_;
}

void Recording::begin() {
  const std::string name =
      fmt::format("palpate-{:%Y%m%d-%H%M%S}.csv", fmt::localtime(std::time(nullptr)));
  std::vector<TouchLog> logs;
  for (std::size_t i = 0; i < hands_; ++i) logs.emplace_back(numbered_path(name, i));
  name_ = name;
  logs_ = std::move(logs);
}

std::string Recording::end() {
  std::vector<TouchLog> logs = std::exchange(logs_, {});
  for (TouchLog& log : logs) log.close();
  return std::exchange(name_, {});
}

void Recording::add(std::size_t hand, const TouchStep& step) {
  std::string why;
  {
    const std::lock_guard lock(mutex_);
    if (logs_.empty()) return;
    try {
      logs_[hand].add(step);
      return;
    } catch (const Error& error) {
      why = error.what();
      logs_.clear();
      name_.clear();
    }
  }
  broken_(why);
}

}  // namespace palpate::app
