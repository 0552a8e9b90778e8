#pragma once

#include <array>
#include <atomic>
#include <string>

#include "base/shared_library.hpp"

namespace palpate::device {

// Numbers of OpenHaptics' C interface to devices (HDAPI 3), as its header hdDefines.h gives them.
namespace hd {

// Values that can be read; positions in mm, forces in N, torques in mN m.
inline constexpr unsigned kCurrentButtons = 0x2000;
inline constexpr unsigned kCurrentPosition = 0x2050;
inline constexpr unsigned kCurrentVelocity = 0x2051;   // mm/s
inline constexpr unsigned kCurrentTransform = 0x2052;  // 16 numbers, column by column
inline constexpr unsigned kModel = 0x2501;
inline constexpr unsigned kSerialNumber = 0x2504;
inline constexpr unsigned kCalibrationStyle = 0x2555;
inline constexpr unsigned kMaximumStiffness = 0x2602;  // N/mm
inline constexpr unsigned kContinuousForce = 0x2604;
inline constexpr unsigned kContinuousTorque = 0x2623;
inline constexpr unsigned kMotorTemperature = 0x2605;  // of each motor; 1: as warm as allowed

// Values that can be set, and a switch.
inline constexpr unsigned kCurrentForce = 0x2700;
inline constexpr unsigned kCurrentTorque = 0x2701;
inline constexpr unsigned kForceOutput = 0x4000;

// Return value of a callback that has to be called again in the next tick.
inline constexpr unsigned kContinue = 1;
inline constexpr unsigned short kDefaultPriority = 0x7fff;

inline constexpr unsigned kNoDevice = 0xffffffff;

// Calibration styles, as bits: automatic; in the inkwell. By hand in a given pose, 1, is not used.
inline constexpr int kAutomatic = 2;
inline constexpr int kInkwell = 4;
// States of calibration.
inline constexpr unsigned kCalibrated = 0x5000;
inline constexpr unsigned kNeedsUpdate = 0x5001;
inline constexpr unsigned kNeedsHand = 0x5002;

// Errors.
inline constexpr unsigned kSuccess = 0;
inline constexpr unsigned kWarmMotors = 0x0200;
inline constexpr unsigned kExceededForce = 0x0201;
inline constexpr unsigned kExceededImpulse = 0x0202;
inline constexpr unsigned kExceededVelocity = 0x0203;
inline constexpr unsigned kForceError = 0x0204;
inline constexpr unsigned kDeviceFault = 0x0300;
inline constexpr unsigned kAlreadyOpen = 0x0301;
inline constexpr unsigned kCommunication = 0x0302;
inline constexpr unsigned kConfiguration = 0x0303;
inline constexpr unsigned kTimer = 0x0304;

}  // namespace hd

/// Facts that an open device reports about itself; 0 or empty: not reported.
struct OpenHapticsFacts {
  std::string model;
  std::string serial_number;
  double continuous_force = 0;   ///< N
  double continuous_torque = 0;  ///< N m
  double maximum_stiffness = 0;  ///< N/m
  int calibration_styles = 0;    ///< bits: hd::kAutomatic, hd::kInkwell, others
};

/// The part of that interface that is used here. Most functions act on the current device.
struct OpenHapticsLibrary {
  using Device = unsigned;
  using Callback = unsigned(void* data);
  using Name = const char*;
  using Handle = unsigned long;

  static constexpr int kMostErrors = 16;  ///< that it may keep

  /// An error, as the library returns it by value.
  struct Failure {
    unsigned code = 0;
    int detail = 0;
    Device device = 0;  // whose
  };

  /// `file`: a path, or empty for the first of its usual names that loads.
  /// @throws Error that states what is missing.
  explicit OpenHapticsLibrary(const std::string& file = "");

  /// The code of the newest error, of whatever device, or hd::kSuccess; clears the list. Bounded
  /// work.
  [[nodiscard]] unsigned take_errors() const noexcept;

  /// Reads the current device's facts. Older libraries lack some, and list errors then.
  [[nodiscard]] OpenHapticsFacts read_facts() const;

  /// The library's name for an error, and the code.
  [[nodiscard]] std::string describe(unsigned code) const;

  SharedLibrary library;
  Device (*init_device)(Name configuration) = library["hdInitDevice"];
  void (*disable_device)(Device device) = library["hdDisableDevice"];
  void (*make_current)(Device device) = library["hdMakeCurrentDevice"];
  void (*enable)(unsigned capability) = library["hdEnable"];
  void (*disable)(unsigned capability) = library["hdDisable"];
  Failure (*get_error)() = library["hdGetError"];  // the newest, and removes it
  Name (*error_name)(unsigned code) = library["hdGetErrorString"];

  void (*begin_frame)(Device device) = library["hdBeginFrame"];
  void (*end_frame)(Device device) = library["hdEndFrame"];
  void (*get_numbers)(unsigned what, double* numbers) = library["hdGetDoublev"];
  void (*get_integers)(unsigned what, int* numbers) = library["hdGetIntegerv"];
  Name (*get_name)(unsigned what) = library["hdGetString"];
  void (*set_numbers)(unsigned what, const double* numbers) = library["hdSetDoublev"];
  unsigned (*check_calibration)() = library["hdCheckCalibration"];
  void (*update_calibration)(unsigned style) = library["hdUpdateCalibration"];

  void (*start_scheduler)() = library["hdStartScheduler"];
  void (*stop_scheduler)() = library["hdStopScheduler"];
  Handle (*schedule)(Callback* callback, void* data,
                     unsigned short priority) = library["hdScheduleAsynchronous"];
  void (*unschedule)(Handle handle) = library["hdUnschedule"];
};

/// Sorts the library's one list of errors by device, so that each device fails for its own errors
/// alone. An error that names a device that was never open counts for the one that calls; one of a
/// closed device is dropped. For each device the first error is kept until it is taken. Any thread;
/// lock-free, bounded work.
class OpenHapticsErrors {
 public:
  static constexpr int kDevices = 16;  ///< at once

  /// A device that was opened; nothing is kept for it yet. False: there are kDevices. One thread at
  /// a time.
  bool open(OpenHapticsLibrary::Device device) noexcept;
  void close(OpenHapticsLibrary::Device device) noexcept;

  /// Sorts what the library has listed, and takes the error kept for `caller`: a code, or
  /// hd::kSuccess.
  unsigned take(const OpenHapticsLibrary& library, OpenHapticsLibrary::Device caller) noexcept;

 private:
  struct Entry {
    std::atomic<OpenHapticsLibrary::Device> device{hd::kNoDevice};
    std::atomic<bool> is_open{false};
    std::atomic<unsigned> code{0};
  };

  Entry* find(OpenHapticsLibrary::Device device) noexcept;
  Entry* find_free() noexcept;
  void keep(const OpenHapticsLibrary::Failure& failure, OpenHapticsLibrary::Device caller) noexcept;

  std::array<Entry, kDevices> entries_;
};

}  // namespace palpate::device
