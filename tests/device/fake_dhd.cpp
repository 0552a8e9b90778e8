// A library with the names of Force Dimension's, and a device behind it: a mass with friction that
// moves when it is told that time passes. Functions fake_* are the tests'.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "device/fake_mass.hpp"

namespace {

using palpate::test::FakeMass;
using Three = FakeMass::Three;

constexpr double kWatchdogUnit = 125e-6;  // s
constexpr int kFlagReset = 3;
constexpr int kFlagForce = 5;
constexpr int kFlagCause = 14;
constexpr int kCauseWatchdog = 3;

struct Device {
  bool plugged = true;
  bool busy = false;
  bool calibrated = true;
  bool has_watchdog = true;
  bool not_a_number = false;
  bool failing = false;
  std::string name = "omega.3";
  bool has_wrist = false;
  bool has_gripper = false;
  bool has_motors = false;  // of wrist and gripper
  int turns = 0;            // times that the velocity of turns was asked for

  bool is_open = false;
  bool forces_on = false;
  bool expert = false;
  int cause = 0;
  double watchdog = 0;  // s; 0: not armed
  double unheard = 0;   // s since the last force
  int thresholds = 0;   // times that somebody changed the velocity threshold
  int velocities = 0;   // times that the velocity was asked for
  FakeMass hand;
  std::array<Three, 3> frame{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double gap = 0;  // m
  Three force{};
  Three torque{};
  double grip = 0;
};

Device device;
const char* words = "no error";

int answer(bool good, const char* otherwise) {
  words = good ? "no error" : otherwise;
  return good ? 0 : -1;
}
int reached() {
  return answer(device.plugged && device.is_open && !device.failing, "communication error");
}
void tell(const Three& from, double* x, double* y, double* z) {
  *x = device.not_a_number ? std::numeric_limits<double>::quiet_NaN() : from[0];
  *y = from[1];
  *z = from[2];
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming)  the maker's names
extern "C" {

int dhdGetDeviceCount() {
  return device.plugged ? 1 : 0;
}
int dhdOpenID(char index) {
  if (answer(device.plugged && index == 0, "no device found") < 0) return -1;
  if (answer(!device.busy, "device in use") < 0) return -1;
  device.is_open = true;
  device.forces_on = false;
  device.unheard = 0;
  device.velocities = 0;
  return 4;  // an id is not an index
}
int dhdClose(char id) {
  if (id != 4) return answer(false, "invalid ID");
  device.is_open = device.forces_on = false;
  device.watchdog = 0;
  return 0;
}
const char* dhdGetSystemName(char) {
  return device.name.c_str();
}
int dhdGetStatus(int* flags, char) {
  if (reached() < 0) return -1;
  std::fill_n(flags, 17, 0);
  flags[0] = flags[1] = flags[2] = 1;
  flags[kFlagReset] = device.calibrated ? 0 : 1;
  flags[kFlagForce] = device.forces_on ? 1 : 0;
  flags[kFlagCause] = device.cause;
  return 0;
}
int dhdEnableForce(unsigned char on, char) {
  if (reached() < 0) return -1;
  device.forces_on = on != 0;
  device.unheard = 0;
  return 0;
}
int dhdEnableExpertMode() {
  device.expert = true;
  return 0;
}
int dhdDisableExpertMode() {
  device.expert = false;
  return 0;
}
int dhdSetWatchdog(unsigned char duration, char) {
  if (answer(device.expert, "expert mode disabled") < 0) return -1;
  if (answer(device.has_watchdog, "feature not available") < 0) return -1;
  device.watchdog = duration * kWatchdogUnit;
  return 0;
}
int dhdSetVelocityThreshold(unsigned, char) {
  ++device.thresholds;
  return 0;
}
int dhdGetPosition(double* x, double* y, double* z, char) {
  if (reached() < 0) return -1;
  tell(device.hand.place, x, y, z);
  return 0;
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char) {
  if (reached() < 0) return -1;
  if (++device.velocities < 3) return answer(false, "too few places yet");
  tell(device.hand.velocity, x, y, z);
  return 1;  // a note, no error
}
unsigned dhdGetButtonMask(char) {
  return 5;
}
bool dhdHasWrist(char) {
  return device.has_wrist;
}
bool dhdHasGripper(char) {
  return device.has_gripper;
}
bool dhdHasActiveWrist(char) {
  return device.has_motors;
}
bool dhdHasActiveGripper(char) {
  return device.has_motors;
}
int dhdGetAngularVelocityRad(double* x, double* y, double* z, char) {
  if (answer(device.has_wrist, "feature not available") < 0 || reached() < 0) return -1;
  if (++device.turns < 3) return answer(false, "too few places yet");
  tell({1, 2, 3}, x, y, z);
  return 0;
}
int dhdGetOrientationFrame(double rows[3][3], char) {
  if (answer(device.has_wrist, "feature not available") < 0 || reached() < 0) return -1;
  for (std::size_t i = 0; i < 3; ++i) tell(device.frame[i], rows[i], rows[i] + 1, rows[i] + 2);
  return 1;  // a note, no error
}
int dhdGetGripperGap(double* gap, char) {
  if (answer(device.has_gripper, "feature not available") < 0 || reached() < 0) return -1;
  *gap = device.gap;
  return 0;
}
int dhdSetForceAndTorqueAndGripperForce(double x, double y, double z, double around_x,
                                        double around_y, double around_z, double grip, char) {
  if (reached() < 0) return -1;
  device.force = {x, y, z};
  device.torque = {around_x, around_y, around_z};
  device.grip = grip;
  device.unheard = 0;
  return 2;  // the motors are saturated: no error
}
const char* dhdErrorGetLastStr() {
  return words;
}

void fake_reset() {
  device = Device();
}
void fake_plug(bool in) {
  device.plugged = in;
  if (!in) device.forces_on = device.is_open = false;
}
void fake_busy(bool on) {
  device.busy = on;
}
void fake_calibrated(bool on) {
  device.calibrated = on;
}
void fake_watchdog(bool there) {
  device.has_watchdog = there;
}
void fake_not_a_number(bool on) {
  device.not_a_number = on;
}
void fake_failing(bool on) {
  device.failing = on;
}
void fake_name(const char* name) {
  device.name = name;
}
void fake_place(double x, double y, double z) {
  device.hand = {.place = {x, y, z}};
}
// Rows of the rotation from the tool's axes to the base's, the maker's both.
void fake_frame(const double* rows) {
  device.has_wrist = true;
  for (std::size_t i = 0; i < 9; ++i) device.frame[i / 3][i % 3] = rows[i];
}
void fake_gap(double gap) {
  device.has_gripper = true;
  device.gap = gap;
}
// What the motors hold, N; the maker's axes.
void fake_force(double* force) {
  for (std::size_t i = 0; i < 3; ++i) force[i] = device.forces_on ? device.force[i] : 0;
}
// The same of wrist and gripper, N m and N.
void fake_torque(double* torque) {
  for (std::size_t i = 0; i < 3; ++i) torque[i] = device.forces_on ? device.torque[i] : 0;
}
double fake_grip() {
  return device.forces_on ? device.grip : 0;
}
void fake_motors(bool there) {
  device.has_motors = there;
}
bool fake_is_open() {
  return device.is_open;
}
int fake_threshold_changes() {
  return device.thresholds;
}
double fake_watchdog_time() {
  return device.watchdog;
}
void fake_advance(double time) {
  device.unheard += time;
  if (device.watchdog > 0 && device.unheard > device.watchdog && device.forces_on) {
    device.forces_on = false;
    device.cause = kCauseWatchdog;
  }
  device.hand.advance(time, device.forces_on ? device.force : Three{});
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
