// Runs servos on a real-time thread and reports what the system granted.
#include "palpate/servo/servo_thread.hpp"

#include <fmt/core.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <system_error>
#include <utility>

#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr std::size_t kStack = 256 * 1024;  // bytes that a step may use (judgement)
constexpr std::size_t kPage = 4096;         // bytes; the kernel's usual page
constexpr unsigned long kTimerSlack = 1;    // ns; the least that the kernel takes, 50000 is usual
constexpr std::uint64_t kTurn = 100'000;    // ns; the least that the kernel grants

std::string reason(int error) {
  return std::generic_category().message(error);
}

RealtimeReport::Request request_priority(int priority) {
  RealtimeReport::Request request;
  request.what = fmt::format("real-time priority {} (SCHED_FIFO)", priority);
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  request.granted = error == 0;
  if (error == EINVAL) {
    request.remedy = "no such priority; give 1 to 99";
  } else if (!request.granted) {
    request.remedy = fmt::format(
        "{}; add '@realtime - rtprio {}' to a file in /etc/security/limits.d, join the group "
        "'realtime' and log in again",
        reason(error), std::max(priority, 95));
  }
  return request;
}

// The kernel's sched_attr; the C library declares it only from version 2.41 on.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;  // ns; of a thread without real-time priority, how long its turns are
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};

// Requests short time slices, so that without real-time priority the thread waits less for others.
// Needs no rights; has no effect before Linux 6.12.
void take_short_turns() {
  SchedulingAttributes now;
  const bool supported = syscall(SYS_sched_getattr, 0, &now, sizeof now, 0) == 0;
  if (!supported || now.policy != SCHED_OTHER) return;
  now.runtime = kTurn;
  syscall(SYS_sched_setattr, 0, &now, 0);
}

// Locking what is to come, too, would make allocations fail once the limit is reached.
bool may_lock_all() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  return limit.rlim_cur == RLIM_INFINITY || geteuid() == 0;
}

RealtimeReport::Request request_memory() {
  RealtimeReport::Request request;
  request.what = "memory locked (mlockall)";
  int error = EPERM;
  if (may_lock_all()) error = mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
  request.granted = error == 0;
  if (!request.granted) {
    request.remedy = fmt::format(
        "{}; add '@realtime - memlock unlimited' to a file in /etc/security/limits.d, join the "
        "group 'realtime' and log in again",
        reason(error));
  }
  return request;
}

bool is_processor(int processor) {
  return processor >= 0 && processor < CPU_SETSIZE;
}

// Processors that the calling thread may run on: "0-3, 6".
std::string allowed_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (pthread_getaffinity_np(pthread_self(), sizeof set, &set) != 0) return "unknown ones";
  const auto allowed = [&set](int i) {
    return is_processor(i) && CPU_ISSET(static_cast<std::size_t>(i), &set);
  };
  std::string list;
  for (int first = 0; first < CPU_SETSIZE; ++first) {
    if (!allowed(first)) continue;
    int last = first;
    while (allowed(last + 1)) ++last;
    list += fmt::format("{}{}", list.empty() ? "" : ", ", first);
    if (last > first) list += fmt::format("-{}", last);
    first = last;
  }
  return list;
}

RealtimeReport::Request answered(std::string what, int error) {
  RealtimeReport::Request request{std::move(what), error == 0, {}};
  if (!request.granted) {
    request.remedy = fmt::format(
        "{}; this thread may run on {}: give one of these, or allow others when you start the "
        "program (systemd: AllowedCPUs=, containers: --cpuset-cpus, or without taskset)",
        reason(error), allowed_processors());
  }
  return request;
}

RealtimeReport::Request request_processor(int processor) {
  int error = EINVAL;
  if (is_processor(processor)) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(processor), &set);
    error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  }
  return answered(fmt::format("pinned to processor {}", processor), error);
}

// Touches the stack once, so that no step is the first to do so.
void warm_stack() {
  std::array<volatile char, kStack> stack;
  for (std::size_t i = 0; i < kStack; i += kPage) stack[i] = 0;
}

}  // namespace

bool RealtimeReport::all_granted() const noexcept {
  return std::ranges::all_of(requests, &RealtimeReport::Request::granted);
}

std::string in_words(const RealtimeReport& report) {
  std::string words;
  for (const RealtimeReport::Request& request : report.requests) {
    words += request.granted ? fmt::format("{}: yes\n", request.what)
                             : fmt::format("{}: not granted ({})\n", request.what, request.remedy);
  }
  return words;
}

RealtimeReport::Request leave_processor(int processor) {
  std::string what = fmt::format("processor {} reserved for the servo", processor);
  cpu_set_t set;
  int error = pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  if (error != 0) return answered(std::move(what), error);
  if (!is_processor(processor) || !CPU_ISSET(static_cast<std::size_t>(processor), &set)) {
    return answered(std::move(what), EINVAL);
  }
  CPU_CLR(static_cast<std::size_t>(processor), &set);
  if (CPU_COUNT(&set) == 0) {
    return {std::move(what), false, "it is the only one this process may use"};
  }
  error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  return answered(std::move(what), error);
}

RealtimeReport make_realtime(const RealtimeOptions& options) {
  RealtimeReport report;
  prctl(PR_SET_TIMERSLACK, kTimerSlack);
  take_short_turns();
  if (options.processor) report.requests.push_back(request_processor(*options.processor));
  if (options.realtime_priority) report.requests.push_back(request_priority(options.priority));
  if (options.lock_memory) report.requests.push_back(request_memory());
  warm_stack();
  return report;
}

double ServoThread::Deadlines::begin(double now) noexcept {
  const double late = std::max(now - next(), 0.0);
  const auto missed = static_cast<std::uint64_t>(std::floor(late / period_));
  index_ += missed + 1;
  skipped_ += missed;
  while (next() <= now) {  // rounding
    ++index_;
    ++skipped_;
  }
  return late;
}

void ServoThread::Deadlines::restart(double now) noexcept {
  start_ = now;
  index_ = 1;
}

namespace {

double rate_for(const DeviceInfo& device, const std::optional<double>& wanted) {
  const double rate = device.keeps_time || !wanted ? device.rate : *wanted;
  if (rate >= ServoThread::kLeastRate && rate <= ServoThread::kMostRate) return rate;
  throw Error(fmt::format(
      "servo: {} steps per second for the device '{}' is out of range; give {} to {} Hz", rate,
      device.name, ServoThread::kLeastRate, ServoThread::kMostRate));
}

}  // namespace

ServoThread::ServoThread(Servo& servo, WaitingClock& clock, const RealtimeOptions& realtime,
                         std::optional<double> rate)
    : servo_(servo), clock_(clock), rate_(rate_for(servo.device().info(), rate)) {
  std::promise<RealtimeReport> answered;
  std::future<RealtimeReport> answer = answered.get_future();
  try {
    thread_ = std::jthread([this, requested = realtime,
                            answered = std::move(answered)](const std::stop_token& stop) mutable {
      answered.set_value(make_realtime(requested));
      run(stop);
    });
  } catch (const std::system_error& error) {
    throw Error(
        fmt::format("servo: cannot start a thread ({}); close other programs", error.what()));
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
  ServoThread::Deadlines deadlines(clock_.now(), 1 / rate_);
  while (!stop.stop_requested() && step(deadlines)) {
  }
  servo_.device().write(Eigen::Vector3d::Zero());
  running_.store(false);
}

// False when the device has come to its end.
bool ServoThread::step(ServoThread::Deadlines& deadlines) noexcept {
  Device& device = servo_.device();
  if (!device.info().keeps_time) clock_.wait_until(deadlines.next());
  const DeviceState state = device.read();
  if (state.status == DeviceState::Status::finished) return false;
  const double now = clock_.now();
  ServoState::Timing timing;
  timing.lateness = deadlines.begin(now);
  if (device.info().keeps_time) deadlines.restart(now);
  skipped_.store(deadlines.skipped(), std::memory_order_relaxed);
  const double start = thread_cpu_seconds();
  servo_.step(state, now);
  timing.computing = thread_cpu_seconds() - start;
  servo_.write();
  servo_.show(timing);
  return state.status != DeviceState::Status::failed;
}

}  // namespace palpate
