#include "apps/palpate/run/preparer.hpp"

#include <exception>
#include <utility>

namespace palpate::app {

Preparer::Preparer(Run& run, const ViewSettings& initial, Failed failed)
    : run_(run),
      initial_(initial),
      held_(initial),
      failed_(std::move(failed)),
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
      held_ = settings;
    } catch (const std::exception& error) {
      take_back();
      failed_(error.what(), held_);
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

// What could not be prepared has left its surface as it was; frames to come go on as before.
void Preparer::take_back() {
  for (std::size_t i = 0; i < run_.felt.size(); ++i) {
    run_.felt.source(i).change(prepared_by(held_, initial_, run_.touched.sources[i].options));
  }
}

}  // namespace palpate::app
