#include "apps/palpate/zwidth/zwidth_map.hpp"

#include <algorithm>
#include <cmath>

#include "apps/palpate/cli/suggestion.hpp"
#include "palpate/base/error.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate::app {

namespace {

DeviceProfile find_profile(const ZWidthOptions& options) {
  const std::vector<DeviceProfile> among =
      options.profiles.empty() ? device_profiles() : read_device_profiles(options.profiles);
  return suggesting(options.profile, among, [&] { return device_profile(options.profile, among); });
}

SimulatedDeviceOptions device_of(const DeviceProfile& profile) {
  SimulatedDeviceOptions device;
  device.mass = profile.mass.value_or(device.mass);
  device.coulomb = profile.coulomb.value_or(0);
  device.resolution = profile.resolution.value_or(device.resolution);
  device.rate = profile.rate.value_or(device.rate);
  return device;
}

std::vector<double> rates(const ZWidthOptions& options, const DeviceProfile& profile) {
  if (!options.rates.empty()) return options.rates;
  std::vector<double> all = {500, 1000, 2000, 4000};
  const double own = profile.rate.value_or(1000);
  if (std::ranges::find(all, own) == all.end()) all.push_back(own);
  std::ranges::sort(all);
  return all;
}

std::vector<double> dampings(const ZWidthOptions& options, const DeviceProfile& profile) {
  if (!options.dampings.empty()) return options.dampings;
  if (profile.damping) return {*profile.damping};
  return {0.1, 0.2, 0.5, 1, 2};
}

std::vector<int> delays(const ZWidthOptions& options) {
  return options.delays.empty() ? std::vector<int>{0, 1, 2} : options.delays;
}

ZWidthRow measure(WallOptions wall) {
  ZWidthRow row;
  row.rate = wall.device.rate;
  row.delay = wall.device.delay;
  row.damping = wall.device.damping;
  row.colgate =
      passive_stiffness(row.damping + wall.guard.damping, 1 / row.rate, row.delay / row.rate);
  wall.guard.passivity.on = false;
  row.stable = stable_stiffness(wall);
  row.passive = rebound_stiffness(wall);
  wall.guard.passivity.on = true;
  row.braked = rebound_stiffness(wall);
  return row;
}

}  // namespace

ZWidthMap measure_zwidth(const ZWidthOptions& options,
                         const std::function<void(double)>& progress) {
  ZWidthMap map;
  map.profile = find_profile(options);
  WallOptions wall;
  wall.device = device_of(map.profile);
  wall.guard.damping = options.wall_damping;
  map.mass = wall.device.mass;
  map.resolution = wall.device.resolution;
  map.coulomb = wall.device.coulomb;
  map.wall_damping = options.wall_damping;
  const std::vector<double> all_rates = rates(options, map.profile);
  const std::vector<int> all_delays = delays(options);
  const std::vector<double> all_dampings = dampings(options, map.profile);
  const std::size_t count = all_rates.size() * all_delays.size() * all_dampings.size();
  for (const double rate : all_rates) {
    for (const int delay : all_delays) {
      for (const double damping : all_dampings) {
        wall.device.rate = rate;
        wall.device.delay = delay;
        wall.device.damping = damping;
        map.rows.push_back(measure(wall));
        progress(static_cast<double>(map.rows.size()) / static_cast<double>(count));
      }
    }
  }
  return map;
}

}  // namespace palpate::app
