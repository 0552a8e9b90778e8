#include "sensor/host_stamps.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::sensor {
namespace {

constexpr double kDrift = 2e-4;  // s per s; crystals differ by less
constexpr double kJump = 1;      // s; a device whose clock jumped so far was started anew

}  // namespace

double HostStamps::host(double device, double arrival) {
  const double found = arrival - device;
  if (!difference_ || device <= device_ || std::abs(found - *difference_) > kJump) {
    difference_ = found;
  } else {
    difference_ = std::min(found, *difference_ + kDrift * std::max(0.0, arrival - arrival_));
  }
  arrival_ = arrival;
  device_ = device;
  return device + *difference_;
}

}  // namespace palpate::sensor
