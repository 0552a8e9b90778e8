// Prepares the next run that a page wants.
#include "apps/palpate/run/opening.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <utility>

#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

bool is_over(const std::future<void>& work) {
  return work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

Opening::~Opening() {
  if (!work_.valid() || is_over(work_)) return;
  given_up_ = true;
  const Waiting waiting(
      fmt::format("waiting until {} is prepared, which comes too late", without_controls(name_)));
  work_.wait();
}

void Opening::begin(Wanted wanted) {
  const std::lock_guard lock(mutex_);
  if (!name_.empty()) throw Error(name_ + " is being read; try again after it");
  share_ = 0;
  std::string name = wanted.name;
  work_ = std::async(std::launch::async, [this, wanted = std::move(wanted)]() mutable {
    prepare_(std::move(wanted), [this](double share) { notify(share); });
  });
  name_ = std::move(name);
}

void Opening::notify(double share) {
  if (given_up_) throw Error("given up");
  share_ = share;
}

std::optional<Opening::News> Opening::look() {
  const std::lock_guard lock(mutex_);
  if (!work_.valid()) return std::nullopt;
  News news{.name = name_, .share = share_};
  if (!is_over(work_)) return news;
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
