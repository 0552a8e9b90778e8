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

using std::chrono::steady_clock;

constexpr std::chrono::microseconds kTickNap{200};  // a frame comes each millisecond

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
