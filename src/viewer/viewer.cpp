// Runs the viewer: the server's thread, and periodic pictures and reports.
#include "palpate/viewer/viewer.hpp"

#include <fmt/core.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/latest.hpp"
#include "palpate/base/clock.hpp"
#include "viewer/access.hpp"
#include "viewer/client_sessions.hpp"
#include "viewer/messages.hpp"
#include "viewer/run_view.hpp"
#include "viewer/scene_encoder.hpp"
#include "viewer/server.hpp"

namespace palpate {
namespace viewer {

// Makes pictures while somebody looks, on a thread of its own. Where nobody looks, it waits and
// holds no field.
class EncoderThread {
 public:
  using Show = std::function<void(EncodedScene)>;

  // `show` is called on the thread.
  EncoderThread(Scene& scene, SceneEncoderOptions options, Show show);
  // Waits for the picture in progress.
  ~EncoderThread() = default;
  EncoderThread(const EncoderThread&) = delete;
  EncoderThread& operator=(const EncoderThread&) = delete;

  // Sets the point budgets of the clients; 0: that one draws nothing now; empty: no client. Any
  // thread.
  void set_budgets(std::set<std::size_t> budgets);

 private:
  void run(const std::stop_token& stop);
  void work(const std::stop_token& stop, const std::set<std::size_t>& budgets);

  Show show_;
  std::mutex mutex_;  // of the budgets; no servo takes it
  std::condition_variable_any changed_;
  std::set<std::size_t> budgets_;
  SceneEncoder encoder_;  // the thread's
  std::jthread thread_;   // last: it uses all of the above
};

EncoderThread::EncoderThread(Scene& scene, SceneEncoderOptions options, Show show)
    : show_(std::move(show)),
      encoder_(scene, std::move(options)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void EncoderThread::set_budgets(std::set<std::size_t> budgets) {
  {
    const std::lock_guard lock(mutex_);
    if (budgets == budgets_) return;
    budgets_ = std::move(budgets);
  }
  changed_.notify_one();
}

void EncoderThread::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::set<std::size_t> budgets;
    {
      std::unique_lock lock(mutex_);
      if (budgets_.empty()) {
        lock.unlock();
        encoder_.rest();
        lock.lock();
        changed_.wait(lock, stop, [this] { return !budgets_.empty(); });
      }
      budgets = budgets_;
    }
    if (!budgets.empty()) work(stop, budgets);
  }
}

void EncoderThread::work(const std::stop_token& stop, const std::set<std::size_t>& budgets) {
  const SteadyClock clock;
  const double begin = clock.now();
  show_(encoder_.encode(budgets, begin));
  const double pause = SceneEncoder::pause_after(clock.now() - begin);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, std::chrono::duration<double>(pause),
                    [&] { return budgets_ != budgets; });
}

}  // namespace viewer

namespace {

using namespace viewer;

}  // namespace

struct Viewer::Parts {
  Parts(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& given,
        ViewerControls controls)
      : run(scene, std::move(servos), given, std::move(controls)),
        server(run.options(), run.sessions()),
        encoder(scene, run.encoding(), [this](EncodedScene encoded) { post(std::move(encoded)); }) {
    server.every(RunView::kStatePeriod, [this] { tick(); });
    server.every(RunView::kReportPeriod, [this] { run.send_faults(); });
    network = std::jthread([this] { server.run(); });
  }
  ~Parts() {
    server.stop();
    network.join();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void tick() {
    encoder.set_budgets(run.budgets());
    run.send_states(SteadyClock().now());
    counts.set(server.counts());
  }
  void post(EncodedScene encoded) {
    auto shared = std::make_shared<EncodedScene>(std::move(encoded));
    server.post([this, shared] { run.show(*shared); });
  }

  RunView run;
  Server server;
  Latest<Viewer::Counts> counts;
  EncoderThread encoder;
  std::jthread network;
};

Viewer::Viewer(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
               ViewerControls controls)
    : parts_(std::make_unique<Parts>(scene, std::move(servos), options, std::move(controls))) {}

Viewer::~Viewer() = default;

std::string Viewer::url() const {
  Listening listening = parts_->server.listening();
  if (listening.everywhere) listening.address = "127.0.0.1";
  return fmt::format("http://{}/#{}", authority(listening), parts_->run.options().token);
}

std::uint16_t Viewer::port() const noexcept {
  return parts_->server.listening().port;
}

std::shared_ptr<const ListeningPort> Viewer::listening() const {
  return parts_->server.keep_listening();
}

Viewer::Counts Viewer::counts() const {
  return parts_->counts.get();
}

void Viewer::restarts(std::string why) {
  Parts& parts = *parts_;
  parts.server.post([&parts, why = std::move(why)] { parts.server.restarts(why); });
}

void Viewer::notice(Viewer::NoticeLevel level, std::string text) {
  Parts& parts = *parts_;
  parts.server.post(
      [&parts, item = Notice{level, std::move(text)}] { parts.run.sessions().send(item); });
}

void Viewer::progress(std::string what, double share) {
  Parts& parts = *parts_;
  parts.server.post([&parts, share, what = std::move(what)]() mutable {
    parts.run.show_progress(std::move(what), share);
  });
}

void Viewer::settings_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.run.sessions().send_settings(); });
}

void Viewer::time_line_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.run.sessions().send_time_line(); });
}

void Viewer::envelope_changed() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.run.sessions().send_envelope(); });
}

void Viewer::record_ended() {
  Parts& parts = *parts_;
  parts.server.post([&parts] { parts.run.sessions().end_record(); });
}

}  // namespace palpate
