// Measures on a device which walls are stable for a person's hand.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/zwidth/zwidth_command.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

namespace {

constexpr auto kLookAtTrial = std::chrono::milliseconds(100);

// The trial beside a device, on a thread of its own.
class TrialThread {
 public:
  TrialThread(Device& device, WaitingClock& clock, const StiffnessTestOptions& options)
      : device_(device), clock_(clock), trial_(device.info(), options) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }

  [[nodiscard]] StiffnessTest::State state() const { return trial_.state(); }
  [[nodiscard]] bool runs() const { return runs_.load(); }
  void stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void run(const std::stop_token& stop) {
    static_cast<void>(make_realtime({}));
    ServoThread::Deadlines deadlines(clock_.now(), 1 / device_.info().rate);
    // The force has gone when the guard had a tenth of a second for it.
    int after = static_cast<int>(0.1 * device_.info().rate);
    while (!stop.stop_requested() && after > 0) {
      clock_.wait_until(deadlines.next());
      const DeviceState hand = device_.read();
      deadlines.begin(clock_.now());
      device_.write(trial_.step(hand, clock_.now()));
      if (trial_.is_over()) --after;
    }
    device_.write(Eigen::Vector3d::Zero());
    runs_.store(false);
  }

  Device& device_;
  WaitingClock& clock_;
  StiffnessTest trial_;
  std::atomic<bool> runs_{true};
  std::jthread thread_;
};

void ask(const StiffnessTestRunOptions& options) {
  fmt::print(stderr,
             "This moves the device: you press on simulated walls, each {:.0f} % stiffer than the "
             "last, until one\nmakes the device vibrate. No force exceeds {:.1f} N; the guard's "
             "brake and stiffness limit are off.\nThe force is switched off when the device "
             "vibrates, moves faster than {} m/s or stops responding.\nHold the handle, clear the "
             "table and keep the other hand on the power switch.\n",
             100 * (options.trial.factor - 1), options.trial.maximum_force, options.trial.fastest);
  if (options.confirmed) return;
  if (isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        "cannot ask for confirmation without a terminal; give --confirm if somebody holds the "
        "device");
  }
  fmt::print(stderr, "Type yes to begin: ");
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw UsageError("not confirmed with yes; the device was not moved");
}

// Prints what the hand should do, when that changes.
StiffnessTest::State lead(TrialThread& thread, const Interruption& interruption) {
  std::string printed;
  while (thread.runs() && !interruption.requested()) {
    const StiffnessTest::State state = thread.state();
    std::string words = fmt::format("{:4.0f} N/m: {}", state.wall, in_words(state.phase));
    if (words != printed) fmt::print(stderr, "{}\n", words);
    printed = std::move(words);
    std::this_thread::sleep_for(kLookAtTrial);
  }
  thread.stop();
  const StiffnessTest::State state = thread.state();
  fmt::print(stderr, "finished: {}\n", in_words(state.phase));
  return state;
}

std::string found(const StiffnessTestRunOptions& options, const DeviceInfo& info,
                  const StiffnessTest::State& state) {
  const Json facts = {
      {"device", info.name},
      {"rate_Hz", info.rate},
      {"wall_damping_Ns_per_m", options.trial.damping},
      {"stable_N_per_m", state.stable},
      {"shook_at_N_per_m", state.phase == StiffnessTest::Phase::unstable ? state.wall : 0},
      {"end", in_words(state.phase)}};
  return facts.dump(2) + "\n";
}

void print_result(const StiffnessTest::State& state, double damping, std::FILE* out) {
  const Style style(out);
  fmt::print(
      out,
      "{} walls up to {:.0f} N/m were stable in this hand, with a wall damping of {:.3g} N s/m\n",
      style.heading("z-width"), state.stable, damping);
  if (state.phase == StiffnessTest::Phase::unstable) {
    fmt::print(out, "a wall of {:.0f} N/m vibrated by {:.2f} mm\n", state.wall,
               1e3 * state.amplitude);
  }
}

}  // namespace

void run_stiffness_test(const StiffnessTestRunOptions& options) {
  if (!names_hardware(options.device)) {
    throw UsageError(
        fmt::format("{} is not a hardware device; give forcedimension, openhaptics or haply, or "
                    "remove --device to simulate the walls",
                    options.device));
  }
  ask(options);
  std::optional<OutputFile> json = output_at(options.json);
  SteadyClock clock;
  const Interruption interruption;
  ThreadedDeviceOptions link;
  link.begin = [] { static_cast<void>(make_realtime({})); };
  const std::unique_ptr<ThreadedDevice> device = open_device(options.device, clock, link);
  fmt::print(stderr, "using {}\n", device->info().name);
  TrialThread thread(*device, clock, options.trial);
  const StiffnessTest::State state = lead(thread, interruption);
  if (json) write_whole(json, found(options, device->info(), state));
  if (state.stable > 0)
    return print_result(state, options.trial.damping, options.json == "-" ? stderr : stdout);
  const std::string reason = device->reason();
  throw Error(
      fmt::format("no wall was pressed: {}", reason.empty() ? in_words(state.phase) : reason));
}

}  // namespace palpate::app
