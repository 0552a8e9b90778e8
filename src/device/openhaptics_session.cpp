#include "device/openhaptics_session.hpp"

#include <fmt/format.h>

#include <mutex>

#include "device/openhaptics_codes.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

// The library is one for the whole program, and so is this.
struct SharedScheduler {
  std::mutex mutex;
  int users = 0;  // of the scheduler
};

SharedScheduler& shared_scheduler() {
  static SharedScheduler only;
  return only;
}

const char* touch_opening_remedy(unsigned code) {
  if (code == hd::kAlreadyOpen) return "It is in use already: end other programs that use it";
  return "Plug it in, switch it on, let the maker's Touch_Setup (in newer drivers "
         "Touch_HeadlessSetup) write its configuration under this name, end other programs that "
         "use it, and let your user use it (udev rules; 'palpate doctor' tells)";
}

}  // namespace

OpenHapticsSession::OpenHapticsSession(const OpenHapticsLibrary& library,
                                       const std::string& configuration)
    : library_(library), name_("openhaptics:" + configuration) {
  const std::lock_guard lock(shared_scheduler().mutex);
  device_ = library_.init_device(configuration.c_str());
  const unsigned code = library_.take_errors();
  if (device_ != hd::kNoDevice && code == hd::kSuccess) return;
  if (device_ != hd::kNoDevice) library_.disable_device(device_);
  throw Error(fmt::format("{}: cannot be opened ({}). {}", name_, library_.words(code),
                          touch_opening_remedy(code)));
}

OpenHapticsSession::~OpenHapticsSession() {
  const std::lock_guard lock(shared_scheduler().mutex);
  if (runs_ && --shared_scheduler().users == 0) library_.stop_scheduler();
  library_.disable_device(device_);
}

void OpenHapticsSession::schedule(OpenHapticsLibrary::Callback* callback, void* data) {
  const std::lock_guard lock(shared_scheduler().mutex);
  library_.schedule(callback, data, hd::kDefaultPriority);
  check("the maker's scheduler takes no callback");
}

void OpenHapticsSession::start() {
  const std::lock_guard lock(shared_scheduler().mutex);
  runs_ = true;
  if (shared_scheduler().users++ == 0) library_.start_scheduler();
  check("the maker's scheduler does not start");
}

void OpenHapticsSession::check(const std::string& what) const {
  const unsigned code = library_.take_errors();
  if (code == hd::kSuccess) return;
  throw Error(fmt::format("{}: {} ({}). Start again", name_, what, library_.words(code)));
}

}  // namespace palpate::device
