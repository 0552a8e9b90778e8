#include "sensor/kinect_depth.hpp"

namespace palpate::sensor {
namespace {

constexpr double kReference = 1.2;   // distance of the reference plane, m
constexpr double kPixel = 1.042e-3;  // a pixel of the sensor (1280 x 960) on that plane, m
constexpr double kBaseline = 0.075;  // from projector to camera, m
constexpr double kShift = 200.375;   // of the reference plane's raw value, pixels of the sensor
constexpr double kFarthest = 15;     // m; steps are above half a metre there
constexpr std::uint16_t kNoValue = 2047;

}  // namespace

Pinhole kinect_pinhole(int width, int height) {
  const double focal = kReference / kPixel * width / 1280;
  return {.fx = focal, .fy = focal, .cx = width / 2.0, .cy = height / 2.0};
}

float kinect_metres(std::uint16_t raw) {
  if (raw >= kNoValue) return 0;
  // Similar triangles: where a ray of the projector meets the reference plane, seen from here.
  const double shift = (raw / 4.0 - kShift) * kPixel;
  if (shift >= kBaseline) return 0;
  const double z = kReference * kBaseline / (kBaseline - shift);
  return z > kFarthest ? 0.0F : static_cast<float>(z);
}

}  // namespace palpate::sensor
