#include "palpate/servo/servo_thread.hpp"

#include <fmt/core.h>

#include <future>
#include <system_error>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/base/thread_clock.hpp"

namespace palpate {
namespace {

double rate_for(const DeviceInfo& device, const std::optional<double>& wanted) {
  const double rate = device.keeps_time || !wanted ? device.rate : *wanted;
  if (rate >= ServoThread::kLeastRate && rate <= ServoThread::kMostRate) return rate;
  throw Error(
      fmt::format("servo: {} steps a second for the device '{}' is out of range; give {} "
                  "to {} Hz",
                  rate, device.name, ServoThread::kLeastRate, ServoThread::kMostRate));
}

}  // namespace

ServoThread::ServoThread(Servo& servo, WaitingClock& clock, const ServoThreadOptions& options)
    : servo_(servo), clock_(clock), rate_(rate_for(servo.device().info(), options.rate)) {
  std::promise<RealtimeReport> answered;
  std::future<RealtimeReport> answer = answered.get_future();
  try {
    thread_ = std::jthread([this, asked = options.realtime,
                            answered = std::move(answered)](const std::stop_token& stop) mutable {
      answered.set_value(make_realtime(asked));
      run(stop);
    });
  } catch (const std::system_error& error) {
    throw Error(
        fmt::format("servo: the system gives no thread ({}); end other programs", error.what()));
  }
  realtime_ = answer.get();
}

ServoThread::~ServoThread() {
  stop();
}

void ServoThread::stop() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void ServoThread::run(const std::stop_token& stop) noexcept {
  Deadlines deadlines(clock_.now(), 1 / rate_);
  while (!stop.stop_requested() && step(deadlines)) {
  }
  servo_.device().write(Eigen::Vector3d::Zero());
  running_.store(false);
}

// False when the device has come to its end.
bool ServoThread::step(Deadlines& deadlines) noexcept {
  Device& device = servo_.device();
  if (!device.info().keeps_time) clock_.wait_until(deadlines.next());
  const DeviceState state = device.read();
  if (state.status == DeviceStatus::finished) return false;
  const double now = clock_.now();
  StepTiming timing;
  timing.lateness = deadlines.begin(now);
  if (device.info().keeps_time) deadlines.restart(now);
  skipped_.store(deadlines.skipped(), std::memory_order_relaxed);
  const double start = thread_cpu_seconds();
  servo_.step(state, now);
  timing.computing = thread_cpu_seconds() - start;
  device.write(servo_.device_force());
  servo_.show(timing);
  return state.status != DeviceStatus::failed;
}

}  // namespace palpate
