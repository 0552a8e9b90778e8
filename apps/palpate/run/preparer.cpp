// Prepares sources again, as a page wants them, on a thread of its own.
#include "apps/palpate/run/preparer.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::app {

Preparer::Preparer(Run& run, const Preparation& initial, Failed failed)
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

void Preparer::want(const Preparation& wanted) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = wanted;
  }
  changed_.notify_one();
}

void Preparer::work(const std::stop_token& stop) {
  while (true) {
    Preparation wanted;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return wanted_.has_value(); })) return;
      wanted = *std::exchange(wanted_, std::nullopt);
    }
    try {
      prepare(wanted);
      held_ = wanted;
    } catch (const std::exception& error) {
      // What could not be prepared has left its surface as it was; frames to come go on as before.
      change_all(held_);
      finish_cut_off();
      failed_(error.what(), held_);
    }
  }
}

// Streams are prepared so from their next frame on.
void Preparer::change_all(const Preparation& wanted) {
  for (std::size_t i = 0; i < run_.loaded.sources.size(); ++i) {
    const SourceOptions& options = run_.loaded.sources[i].plan.options;
    run_.loaded.scene.source(i).change(prepared_by(wanted, initial_, options));
  }
}

void Preparer::prepare(const Preparation& wanted) {
  for (const LoadedSource& loaded : run_.loaded.sources) {
    if (!loaded.paged) continue;
    throw Error(
        fmt::format("{} is read from disk as it was opened; start again to prepare it otherwise",
                    loaded.plan.argument.name));
  }
  change_all(wanted);
  for (std::size_t i = 0; i < run_.loaded.sources.size(); ++i) {
    const LoadedSource& loaded = run_.loaded.sources[i];
    if (loaded.on_demand && !loaded.on_demand->done()) {
      loaded.on_demand->cancel();
      cut_off_.insert(i);
    }
    if (loaded.cloud) run_.loaded.scene.source(i).set(*loaded.cloud);
    cut_off_.erase(i);
  }
}

// Prepares what was cancelled while it was being prepared, by what holds.
void Preparer::finish_cut_off() {
  for (const std::size_t i : std::exchange(cut_off_, {})) {
    try {
      run_.loaded.scene.source(i).set(*run_.loaded.sources[i].cloud);
    } catch (const std::exception&) {
      continue;  // the part that was there stays, and why is reported already
    }
  }
}

}  // namespace palpate::app
