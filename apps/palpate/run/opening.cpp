// Prepares a file that a page sent, for the next run.
#include "apps/palpate/run/opening.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

constexpr double kTellAgain = 5;  // s

bool is_over(const std::future<void>& work) {
  return work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

Opening::~Opening() {
  if (!work_.valid() || is_over(work_)) return;
  fmt::print(stderr, "waiting until {} is read, which comes too late; Ctrl-C ends at once\n",
             without_controls(name_));
}

void Opening::begin(const std::string& name, std::string bytes) {
  const std::lock_guard lock(mutex_);
  if (!name_.empty()) throw Error(name_ + " is being read; try again after it");
  work_ = std::async(std::launch::async, [this, name, bytes = std::move(bytes)]() mutable {
    prepare_(name, std::move(bytes));
  });
  name_ = name;
  began_.reset();
}

std::optional<Opening::News> Opening::look(double now) {
  const std::lock_guard lock(mutex_);
  if (!work_.valid()) return std::nullopt;
  if (!began_) began_ = told_ = now;
  News news{.name = name_, .seconds = now - *began_};
  if (!is_over(work_)) {
    if (now - told_ < kTellAgain) return std::nullopt;
    told_ = now;
    return news;
  }
  try {
    work_.get();
    news.kind = News::Kind::prepared;
  } catch (const std::exception& error) {
    news.kind = News::Kind::refused;
    news.problem = error.what();
    name_.clear();
  }
  return news;
}

}  // namespace palpate::app
