#include "device/openhaptics_errors.hpp"

#include <algorithm>

#include "device/openhaptics_codes.hpp"

namespace palpate::device {

bool OpenHapticsErrors::open(OpenHapticsLibrary::Device device) noexcept {
  File* file = find(device);
  if (file == nullptr) file = find_free();
  if (file == nullptr) return false;
  file->device = device;
  file->code = hd::kSuccess;
  file->is_open = true;
  return true;
}

void OpenHapticsErrors::close(OpenHapticsLibrary::Device device) noexcept {
  if (File* file = find(device)) file->is_open = false;
}

unsigned OpenHapticsErrors::take(const OpenHapticsLibrary& library,
                                 OpenHapticsLibrary::Device asker) noexcept {
  for (int i = 0; i < OpenHapticsLibrary::kMostErrors; ++i) {
    const OpenHapticsLibrary::Failure failure = library.get_error();
    if (failure.code == hd::kSuccess) break;
    keep(failure, asker);
  }
  File* own = find(asker);
  return own == nullptr ? hd::kSuccess : own->code.exchange(hd::kSuccess);
}

void OpenHapticsErrors::keep(const OpenHapticsLibrary::Failure& failure,
                             OpenHapticsLibrary::Device asker) noexcept {
  File* file = find(failure.device);
  if (file == nullptr) file = find(asker);
  if (file == nullptr || !file->is_open) return;
  unsigned none = hd::kSuccess;
  file->code.compare_exchange_strong(none, failure.code);
}

OpenHapticsErrors::File* OpenHapticsErrors::find(OpenHapticsLibrary::Device device) noexcept {
  if (device == hd::kNoDevice) return nullptr;
  auto* const found =
      std::ranges::find_if(files_, [device](const File& file) { return file.device == device; });
  return found == files_.end() ? nullptr : found;
}

// One that was never used, rather than one whose device is closed: that one's late errors are to be
// dropped.
OpenHapticsErrors::File* OpenHapticsErrors::find_free() noexcept {
  for (File& file : files_) {
    if (file.device == hd::kNoDevice) return &file;
  }
  for (File& file : files_) {
    if (!file.is_open) return &file;
  }
  return nullptr;
}

}  // namespace palpate::device
