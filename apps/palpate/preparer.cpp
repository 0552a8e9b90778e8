#include "apps/palpate/preparer.hpp"

#include <exception>
#include <utility>

namespace palpate::app {

Preparer::Preparer(Run& run, const ViewSettings& initial,
                   std::function<void(const std::string&)> complain)
    : run_(run),
      initial_(initial),
      complain_(std::move(complain)),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

Preparer::~Preparer() = default;

void Preparer::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Preparer::want(const ViewSettings& settings) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = settings;
  }
  changed_.notify_one();
}

void Preparer::work(const std::stop_token& stop) {
  while (true) {
    ViewSettings settings;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return wanted_.has_value(); })) return;
      settings = *std::exchange(wanted_, std::nullopt);
    }
    try {
      prepare(settings);
    } catch (const std::exception& error) {
      complain_(error.what());
    }
  }
}

// What lives is prepared so from its next frame on.
void Preparer::prepare(const ViewSettings& settings) {
  for (std::size_t i = 0; i < run_.felt.size(); ++i) {
    Source& source = run_.felt.source(i);
    const TouchedSource& touched = run_.touched.sources[i];
    source.change(prepared_by(settings, initial_, touched.options));
    if (touched.cloud) source.set(*touched.cloud);
  }
}

}  // namespace palpate::app
