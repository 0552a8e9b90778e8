#include "device/profile_info.hpp"

namespace palpate::device {

DeviceInfo info_of(const DeviceProfile& profile, const std::string& name) {
  DeviceInfo info;
  info.name = name;
  info.maximum_force = profile.maximum_force.value_or(*device_profile("unknown").maximum_force);
  info.maximum_stiffness = profile.maximum_stiffness.value_or(info.maximum_stiffness);
  info.damping = profile.damping.value_or(info.damping);
  info.mass = profile.mass.value_or(info.mass);
  info.rate = profile.rate.value_or(info.rate);
  info.delay = profile.delay;
  info.workspace_radius = profile.workspace_radius.value_or(info.workspace_radius);
  return info;
}

}  // namespace palpate::device
