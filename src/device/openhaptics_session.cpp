#include "device/openhaptics_session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <mutex>

#include "device/openhaptics_codes.hpp"
#include "device/openhaptics_common.hpp"
#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

const char* touch_opening_remedy(unsigned code) {
  if (code == hd::kAlreadyOpen) return "It is in use already: end other programs that use it";
  return "Plug it in, switch it on, let the maker's Touch_Setup (in newer drivers "
         "Touch_HeadlessSetup) write its configuration under this name, end other programs that "
         "use it, and let your user use it (udev rules; 'palpate doctor' tells)";
}

}  // namespace

OpenHapticsCommon& openhaptics_common() {
  static OpenHapticsCommon only;
  return only;
}

OpenHapticsSession::OpenHapticsSession(const OpenHapticsLibrary& library,
                                       const std::string& configuration, double now)
    : library_(library), name_("openhaptics:" + configuration), device_(hd::kNoDevice) {
  OpenHapticsCommon& common = openhaptics_common();
  const std::lock_guard lock(common.mutex);
  require_pause(now);
  const FrameGate::Stillness stillness(common.gate, kPatience);
  require(stillness.all());
  open(configuration);
}

OpenHapticsSession::~OpenHapticsSession() {
  OpenHapticsCommon& common = openhaptics_common();
  const std::lock_guard lock(common.mutex);
  // Where others do not stand still in time: a device that is left open may hold a force for ever.
  const FrameGate::Stillness stillness(common.gate, kPatience);
  if (runs_ && --common.users == 0) library_.stop_scheduler();
  library_.disable_device(device_);
  (void)common.errors.take(library_, device_);
  common.errors.close(device_);
}

void OpenHapticsSession::run(const std::shared_ptr<OpenHapticsFrames>& frames) {
  OpenHapticsCommon& common = openhaptics_common();
  const std::lock_guard lock(common.mutex);
  const FrameGate::Stillness stillness(common.gate, kPatience);
  require(stillness.all());
  // The last call deletes it. It is given away first: a scheduler that complains may call all the
  // same.
  auto own = std::make_unique<std::shared_ptr<OpenHapticsFrames>>(frames);
  common.gate.add(frames->lane());
  library_.schedule(&OpenHapticsFrames::call, own.release(), hd::kDefaultPriority);
  check("the maker's scheduler takes no callback");
  runs_ = true;
  if (common.users++ == 0) library_.start_scheduler();
  check("the maker's scheduler does not start");
}

void OpenHapticsSession::require_pause(double now) const {
  OpenHapticsCommon& common = openhaptics_common();
  if (!common.gate.is_used()) common.opened.clear();
  const auto last = common.opened.find(name_);
  const double rest = last == common.opened.end() ? 0 : last->second + kPause - now;
  if (rest > 0) {
    fail(fmt::format(
        "is opened again in {} s, as that takes the force from the maker's other devices for a "
        "moment. Wait so long, or let them go",
        std::ceil(rest)));
  }
  common.opened[name_] = now;
}

// While nobody else speaks. The library may call the errors of a device that does not open those of
// the one that was current before.
void OpenHapticsSession::open(const std::string& configuration) {
  OpenHapticsErrors& errors = openhaptics_common().errors;
  (void)errors.take(library_, hd::kNoDevice);  // those from before are filed
  device_ = library_.init_device(configuration.c_str());
  const bool is_open = device_ != hd::kNoDevice;
  const bool has_file = is_open && errors.open(device_);
  const unsigned code = has_file ? errors.take(library_, device_) : library_.take_errors();
  if (has_file && code == hd::kSuccess) return;
  if (is_open) library_.disable_device(device_);
  errors.close(device_);
  if (is_open && !has_file) fail("too many devices are open. Let one go");
  fail(fmt::format("cannot be opened ({}). {}", library_.words(code), touch_opening_remedy(code)));
}

void OpenHapticsSession::require(bool all_still) const {
  if (all_still) return;
  fail(
      "is not opened now, since another of the maker's devices does not stand still. Look at that "
      "one's cable and its power");
}

void OpenHapticsSession::check(const std::string& what) const {
  const unsigned code = openhaptics_common().errors.take(library_, device_);
  if (code == hd::kSuccess) return;
  fail(fmt::format("{} ({}). Start again", what, library_.words(code)));
}

void OpenHapticsSession::fail(const std::string& words) const {
  throw Error(fmt::format("{}: {}", name_, words));
}

}  // namespace palpate::device
