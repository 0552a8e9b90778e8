#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/known_devices.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Haptic devices and depth cameras on USB: which are there, may this user open them, does a driver
/// of the kernel hold one, do cameras share a bus?
[[nodiscard]] Findings check_devices(const System& system, const std::vector<Found>& found);

/// The command that lets this user open devices on USB: from within a container, where the kernel
/// has no USB, or by rules for udev.
[[nodiscard]] std::string usb_command(const System& system);

}  // namespace palpate::app::doctor
