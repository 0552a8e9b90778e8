// Opens, runs and closes devices in OpenHaptics' one scheduler.
#include "device/openhaptics_scheduler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;
using std::chrono::steady_clock;

constexpr double kMillimetre = 1e-3;                // m; OpenHaptics measures in mm (the maker's)
constexpr std::chrono::microseconds kTickNap{200};  // a frame comes each millisecond

// The maker's x is to the right, y up, z towards the operator.
Vector3d from_hd(const Vector3d& v) {
  return {v.x(), -v.z(), v.y()};
}
Vector3d to_hd(const Vector3d& v) {
  return {v.x(), v.z(), -v.y()};
}

steady_clock::duration seconds(double duration) {
  return std::chrono::duration_cast<steady_clock::duration>(
      std::chrono::duration<double>(duration));
}

// Picks a style that the device supports; never the reset of encoders, which takes the present pose
// for the one that it should be in.
unsigned calibration_style(int supported) {
  return (supported & hd::kAutomatic) != 0 ? hd::kAutomatic : hd::kInkwell;
}

const char* touch_opening_remedy(unsigned code) {
  if (code == hd::kAlreadyOpen) return "It is already in use: close other programs that use it";
  return "Plug it in, switch it on, configure it under this name with the vendor's Touch_Setup "
         "(Touch_HeadlessSetup in newer drivers), close other programs that use it, and give your "
         "user access (udev rules; 'palpate doctor' explains)";
}

// Shared by all devices of a program. Threads that open or close a device take the mutex; frames
// never do, and use only `errors`.
struct Shared {
  struct Running {
    OpenHapticsFrames* frames = nullptr;
    OpenHapticsLibrary::Handle handle = 0;  // of the scheduler's
  };

  std::mutex mutex;
  std::vector<Running> running;
  decltype(OpenHapticsLibrary::init_device) init_device = nullptr;  // whose scheduler runs
  std::map<std::string, double> tried;                              // when each was opened last, s
  OpenHapticsErrors errors;
};

Shared& shared_by_all() {
  static Shared only;
  return only;
}

unsigned call_tick(void* frames) noexcept {
  static_cast<OpenHapticsFrames*>(frames)->tick();
  return hd::kContinue;
}

// Keeps all devices at rest as long as it lives. With the mutex.
class Rest {
 public:
  explicit Rest(const OpenHapticsLibrary& library) : library_(library) {
    for (const auto& each : shared_.running) each.frames->rest();
    const auto end = steady_clock::now() + seconds(OpenHapticsSession::kPatience);
    while (!is_complete() && steady_clock::now() < end) std::this_thread::sleep_for(kTickNap);
  }
  ~Rest() {
    for (const auto& each : shared_.running) each.frames->resume();
    if (is_stopped_ && !shared_.running.empty()) start();
  }
  Rest(const Rest&) = delete;
  Rest& operator=(const Rest&) = delete;

  [[nodiscard]] bool is_complete() const {
    return std::ranges::all_of(shared_.running,
                               [](const auto& each) { return each.frames->is_at_rest(); });
  }
  // Waits for a tick that is in progress.
  void stop_scheduler() {
    is_stopped_ = true;
    if (shared_.running.empty()) return;
    library_.stop_scheduler();
    for (const auto& each : shared_.running) library_.unschedule(each.handle);
  }

 private:
  // Whether callbacks outlast a stop is not documented, so all are scheduled again. Errors are
  // found by the first frame, or by the thread that misses it.
  void start() {
    for (auto& each : shared_.running) {
      each.handle = library_.schedule(call_tick, each.frames, hd::kDefaultPriority);
    }
    library_.start_scheduler();
  }

  const OpenHapticsLibrary& library_;
  Shared& shared_ = shared_by_all();
  bool is_stopped_ = false;
};

}  // namespace

void OpenHapticsHand::end_frame(const Vector3d& force) const noexcept {
  library.set_numbers(hd::kCurrentForce, to_hd(force).eval().data());
  library.end_frame(device);
}

DeviceState OpenHapticsHand::read() const noexcept {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  int buttons = 0;
  library.get_numbers(hd::kCurrentPosition, position.data());
  library.get_numbers(hd::kCurrentVelocity, velocity.data());
  library.get_integers(hd::kCurrentButtons, &buttons);
  DeviceState state;
  state.position = kMillimetre * from_hd(position);
  state.velocity = kMillimetre * from_hd(velocity);
  state.buttons = static_cast<std::uint32_t>(buttons);
  return state;
}

double OpenHapticsHand::warmest_motor() const noexcept {
  std::array<double, 6> temperatures{};  // of three motors or six
  library.get_numbers(hd::kMotorTemperature, temperatures.data());
  (void)take_error();  // older libraries do not support it
  return std::ranges::max(temperatures);
}

void OpenHapticsFrames::request(const Vector3d& force) noexcept {
  wanted_.set({force, clock_.now(), ++requested_});
}

std::optional<OpenHapticsFrames::Answer> OpenHapticsFrames::answer(double patience) noexcept {
  TimePoint end = steady_clock::now() + seconds(patience);
  while (true) {
    const Answer newest = answers_.get();
    if (newest.number == requested_) return newest;
    const TimePoint now = steady_clock::now();
    // Time at rest does not count.
    end = std::max(end, std::min(now, runs_since_.load()) + seconds(patience));
    if (now >= end) return std::nullopt;
    wakeup_.wait_until(end);
  }
}

void OpenHapticsFrames::tick() noexcept {
  if (over_) return;
  if (runs_since_.load() != TimePoint::max()) {
    at_rest_ = false;
    frame();
  } else if (!at_rest_) {
    frame_without_force();
    at_rest_ = true;
  }
}

void OpenHapticsFrames::frame() noexcept {
  hand_.begin_frame();
  if (over_) return;  // it may have hung
  if (!newest_.temperature) {
    keep_failure();
    newest_.temperature = hand_.warmest_motor();
  }
  if (const int styles = calibrate_.exchange(0); styles != 0) {
    hand_.library.update_calibration(calibration_style(styles));
  }
  newest_.calibration = hand_.library.check_calibration();
  newest_.state = hand_.read();
  keep_failure();  // before there is a force
  if (const std::optional<Wanted> wanted = wanted_.look()) taken_ = *wanted;
  hand_.end_frame(permitted(newest_.state));
  keep_failure();
  const bool is_awaited = newest_.number != taken_.number;
  newest_.number = taken_.number;
  answers_.set(newest_);
  if (is_awaited) wakeup_.post();
}

void OpenHapticsFrames::frame_without_force() noexcept {
  hand_.begin_frame();
  if (over_) return;
  hand_.end_frame(Vector3d::Zero());
  keep_failure();
}

Vector3d OpenHapticsFrames::permitted(const DeviceState& state) const noexcept {
  const bool recent = clock_.now() - taken_.time <= kForceTimeout;
  const bool finite = state.position.allFinite() && state.velocity.allFinite();
  const bool calibrated = newest_.calibration != hd::kNeedsHand;
  const bool good = newest_.failure == hd::kSuccess && calibrated;
  return recent && finite && good ? taken_.force : Vector3d::Zero();
}

void OpenHapticsFrames::keep_failure() noexcept {
  const unsigned code = hand_.take_error();
  if (newest_.failure == hd::kSuccess) newest_.failure = code;
}

OpenHapticsSession::OpenHapticsSession(const OpenHapticsLibrary& library,
                                       const std::string& configuration, const Clock& clock)
    : library_(library), name_("openhaptics:" + configuration) {
  Shared& shared = shared_by_all();
  const std::lock_guard lock(shared.mutex);
  require_interval(clock.now());
  if (!shared.running.empty() && shared.init_device != library_.init_device) {
    fail("is not opened: another copy of its library is in use. Give both the same library=");
  }
  Rest rest(library_);
  if (!rest.is_complete()) {
    fail("is not opened: another device of the vendor does not stop. Check its cable");
  }
  rest.stop_scheduler();
  open(configuration);
  facts_ = library_.read_facts();
  (void)shared.errors.take(library_, device_);  // of what it does not support
  library_.enable(hd::kForceOutput);            // the first frame finds an error
  frames_ = std::make_unique<OpenHapticsFrames>(library_, device_, clock, shared.errors);
  shared.running.push_back({frames_.get()});
  shared.init_device = library_.init_device;
}

// Goes on even where a device does not come to rest in time: one that is left open might hold a
// force for ever.
OpenHapticsSession::~OpenHapticsSession() {
  Shared& shared = shared_by_all();
  const std::lock_guard lock(shared.mutex);
  Rest rest(library_);
  frames_->end();
  rest.stop_scheduler();
  std::erase_if(shared.running, [this](const auto& each) { return each.frames == frames_.get(); });
  library_.make_current(device_);
  library_.disable(hd::kForceOutput);
  library_.disable_device(device_);
  (void)shared.errors.take(library_, device_);
  shared.errors.close(device_);
  // Whether a stop waits for a frame that hangs is not documented: it may come back to its frames.
  if (!frames_->is_at_rest()) (void)frames_.release();
}

unsigned OpenHapticsSession::take_error() const noexcept {
  return shared_by_all().errors.take(library_, device_);
}

void OpenHapticsSession::require_interval(double now) const {
  Shared& shared = shared_by_all();
  if (shared.running.empty()) shared.tried.clear();
  const auto last = shared.tried.find(name_);
  const double left = last == shared.tried.end() ? 0 : last->second + kInterval - now;
  if (left > 0) {
    fail(
        fmt::format("can be reopened in {} s, because that briefly interrupts the force of the "
                    "vendor's other devices. Wait that long, or close them",
                    std::ceil(left)));
  }
  shared.tried[name_] = now;
}

// The library may attribute the errors of a device that does not open to the one that was current
// before.
void OpenHapticsSession::open(const std::string& configuration) {
  OpenHapticsErrors& errors = shared_by_all().errors;
  (void)errors.take(library_, hd::kNoDevice);  // sorts those from before
  device_ = library_.init_device(configuration.c_str());
  const bool is_open = device_ != hd::kNoDevice;
  const bool has_entry = is_open && errors.open(device_);
  const unsigned code = has_entry ? errors.take(library_, device_) : library_.take_errors();
  if (has_entry && code == hd::kSuccess) return;
  if (is_open) library_.disable_device(device_);
  errors.close(device_);
  if (is_open && !has_entry) fail("too many devices are open. Close one");
  fail(fmt::format("cannot be opened ({}). {}", library_.describe(code),
                   touch_opening_remedy(code)));
}

void OpenHapticsSession::fail(const std::string& words) const {
  throw Error(fmt::format("{}: {}", name_, words));
}

}  // namespace palpate::device
