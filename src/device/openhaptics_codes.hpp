#pragma once

// Numbers of OpenHaptics' C interface to devices (HDAPI 3), as its header hdDefines.h gives them.
namespace palpate::device::hd {

// What can be asked for; of places in mm, of forces in N.
inline constexpr unsigned kCurrentButtons = 0x2000;
inline constexpr unsigned kCurrentPosition = 0x2050;
inline constexpr unsigned kCurrentVelocity = 0x2051;  // mm/s
inline constexpr unsigned kModel = 0x2501;
inline constexpr unsigned kSerialNumber = 0x2504;
inline constexpr unsigned kCalibrationStyle = 0x2555;
inline constexpr unsigned kMaximumStiffness = 0x2602;  // N/mm
inline constexpr unsigned kContinuousForce = 0x2604;
inline constexpr unsigned kMotorTemperature =
    0x2605;  // of each motor, from 0 to 1: as warm as may be

// What can be set, and what can be switched on.
inline constexpr unsigned kCurrentForce = 0x2700;
inline constexpr unsigned kForceOutput = 0x4000;

// What a callback answers: is it over, or to be called in the next tick?
inline constexpr unsigned kDone = 0;
inline constexpr unsigned kContinue = 1;
inline constexpr unsigned short kDefaultPriority = 0x7fff;

inline constexpr unsigned kNoDevice = 0xffffffff;

// How a device is calibrated, as bits: by hand in a place that it asks for; by itself; in its
// inkwell.
inline constexpr int kEncoderReset = 1;
inline constexpr int kAutomatic = 2;
inline constexpr int kInkwell = 4;
// Whether it is.
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

}  // namespace palpate::device::hd
