// What tests ask and tell the library that stands for OpenHaptics'.
#include <cstddef>

#include "device/fake_hd_library.hpp"

namespace {

using palpate::test::fake_hd_library;
using palpate::test::FakeHd;
using palpate::test::FakeHdLibrary;
using Held = FakeHdLibrary::Lock;

}  // namespace

extern "C" {

void fake_reset() {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  fake.faults = {};
  fake.errors.clear();
  fake.disturbances = 0;
  fake.runs_by_itself = true;
  for (FakeHdLibrary::Device& each : fake.devices) each.hand = {};
}
// Ticks at 1 kHz, or as fake_tick() tells.
void fake_by_itself(bool on) {
  FakeHdLibrary& fake = fake_hd_library();
  Held lock(fake.mutex);
  fake.runs_by_itself = on;
  fake.changed.notify_all();
  if (!on) fake.changed.wait(lock, [&] { return !fake.is_ticking; });
}
// Lets so many ticks pass, or as many as there are until it hangs.
void fake_tick(int count) {
  FakeHdLibrary& fake = fake_hd_library();
  Held lock(fake.mutex);
  fake.changed.wait(lock, [&] { return !fake.is_ticking || fake.is_stuck; });
  fake.granted = fake.runs ? count : 0;
  fake.changed.notify_all();
  fake.changed.wait(lock, [&] { return fake.granted == 0 || fake.is_stuck; });
}
void fake_set(const FakeHd* faults) {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  fake.faults = *faults;
  if (!faults->plugged) fake.devices[0].let_go();
  fake.changed.notify_all();
}
// An error that names a device, or none.
void fake_error(unsigned device, unsigned code) {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  fake.errors.push_back({code, 0, device});
}
// mm
void fake_place(double x, double y, double z) {
  constexpr double kUnit = FakeHdLibrary::kMillimetre;
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  fake.devices[0].hand = {.place = {x * kUnit, y * kUnit, z * kUnit}};
}
// What a device's motors hold, N; the maker's axes.
void fake_force_of(unsigned device, double* force) {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  for (std::size_t i = 0; i < 3; ++i) force[i] = fake.devices.at(device).held[i];
}
// The torque that was set last for the first device, mN m.
void fake_torque(double* torque) {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  for (std::size_t i = 0; i < 3; ++i) torque[i] = fake.devices[0].torque[i];
}
void fake_force(double* force) {
  fake_force_of(0, force);
}
// How often a device was opened or closed while the scheduler ran, or another device was used or
// held a force meanwhile.
int fake_disturbances() {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  return fake.disturbances;
}
bool fake_is_open() {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  return fake.devices[0].is_open;
}
bool fake_runs() {
  FakeHdLibrary& fake = fake_hd_library();
  const Held lock(fake.mutex);
  return fake.runs;
}

}  // extern "C"
