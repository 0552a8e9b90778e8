#include "apps/palpate/recording.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "apps/palpate/numbered_path.hpp"

namespace palpate::app {

std::string Recording::record(bool on) {
  const std::lock_guard lock(mutex_);
  for (TouchLog& log : logs_) log.close();
  logs_.clear();
  if (!on) return std::exchange(name_, {});
  name_ = fmt::format("palpate-{:%Y%m%d-%H%M%S}.csv", fmt::localtime(std::time(nullptr)));
  for (std::size_t i = 0; i < hands_; ++i) logs_.emplace_back(numbered_path(name_, i));
  return name_;
}

void Recording::add(std::size_t hand, const TouchStep& step) {
  const std::lock_guard lock(mutex_);
  if (!logs_.empty()) logs_[hand].add(step);
}

}  // namespace palpate::app
