#include "sensor/simulated_keys.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "base/angle.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr double kMostWhole = 1e6;

double number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) {
    throw Error(fmt::format("'{}' is not a finite number", text));
  }
  return value;
}

int whole(const std::string& text) {
  const double value = number(text);
  if (value != std::floor(value) || value < 0 || value > kMostWhole) {
    throw Error(fmt::format("'{}' is not a whole number from 0 to {:g}", text, kMostWhole));
  }
  return static_cast<int>(value);
}

NoiseKind noise_kind(const std::string& text) {
  if (text == "none") return NoiseKind::none;
  if (text == "a") return NoiseKind::independent;
  if (text == "b") return NoiseKind::blurred;
  if (text == "c") return NoiseKind::quantised;
  throw Error(fmt::format("'{}' is none of none, a, b and c", text));
}

// The same view with other pixels.
void set_width(CameraModel& camera, int width) {
  const double scale = static_cast<double>(width) / camera.width;
  camera.width = width;
  camera.height = static_cast<int>(std::lround(camera.height * scale));
  Pinhole& p = camera.pinhole;
  p = {p.fx * scale, p.fy * scale, (p.cx + 0.5) * scale - 0.5, (p.cy + 0.5) * scale - 0.5};
}

void turn_about_vertical(SimulatedSetup& setup, double angle) {
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  setup.camera.T_world_camera = turn * setup.camera.T_world_camera;
}

struct Key {
  const char* name;
  void (*set)(SimulatedSetup&, const std::string&);
};

using Text = const std::string&;
constexpr std::array<Key, 12> kKeys = {{
    {"noise", [](SimulatedSetup& s, Text v) { s.camera.noise.kind = noise_kind(v); }},
    {"seed",
     [](SimulatedSetup& s, Text v) { s.camera.noise.seed = static_cast<std::uint64_t>(whole(v)); }},
    {"silhouettes", [](SimulatedSetup& s, Text v) { s.camera.noise.silhouettes = whole(v) != 0; }},
    {"rate", [](SimulatedSetup& s, Text v) { s.camera.rate = number(v); }},
    {"phase", [](SimulatedSetup& s, Text v) { s.camera.phase = number(v); }},
    {"jitter", [](SimulatedSetup& s, Text v) { s.camera.jitter = number(v); }},
    {"dropped", [](SimulatedSetup& s, Text v) { s.camera.dropped = number(v); }},
    {"frames", [](SimulatedSetup& s, Text v) { s.camera.frames = whole(v); }},
    {"loop", [](SimulatedSetup& s, Text v) { s.camera.loop = whole(v); }},
    {"view", [](SimulatedSetup& s, Text v) { turn_about_vertical(s, kDegree * number(v)); }},
    {"width", [](SimulatedSetup& s, Text v) { set_width(s.camera.camera, whole(v)); }},
    {"error",
     [](SimulatedSetup& s, Text v) {
       // 1 mm goes with 1/6 degree, as 3 mm with 0.5 degrees.
       const double meters = number(v);
       s.camera.T_camera_told =
           calibration_error(meters, kDegree * meters / 0.006, s.camera.noise.seed);
     }},
}};

std::string known_keys() {
  std::string text;
  for (const Key& key : kKeys) text += (text.empty() ? "" : ", ") + std::string(key.name);
  return text;
}

// Says of which key a bad value was.
void set(SimulatedSetup& setup, const Key& key, const std::string& value) {
  try {
    key.set(setup, value);
  } catch (const Error& error) {
    throw Error(fmt::format("simulated camera: {}: {}", key.name, error.what()));
  }
}

}  // namespace

void set_simulated(SimulatedSetup& setup, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw Error(fmt::format("a simulated camera takes KEY=VALUE, not '{}'; keys are {}", assignment,
                            known_keys()));
  }
  const std::string name = assignment.substr(0, equals);
  for (const Key& key : kKeys) {
    if (name == key.name) return set(setup, key, assignment.substr(equals + 1));
  }
  throw Error(fmt::format("a simulated camera has no '{}'; keys are {}", name, known_keys()));
}

}  // namespace palpate
