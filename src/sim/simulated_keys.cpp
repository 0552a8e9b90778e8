// Parses the KEY=VALUE options of simulated cameras.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/numbers.hpp"
#include "base/parse_number.hpp"
#include "palpate/base/error.hpp"
#include "sim/simulated_camera.hpp"

namespace palpate {
namespace {

constexpr double kMostWhole = 1e6;  // largest whole number (judgement)

double number(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value || !std::isfinite(*value)) {
    throw Error(fmt::format("'{}' is not a finite number", text));
  }
  return *value;
}

int whole(const std::string& text) {
  const double value = number(text);
  if (value != std::floor(value) || value < 0 || value > kMostWhole) {
    throw Error(fmt::format("'{}' is not a whole number from 0 to {:g}", text, kMostWhole));
  }
  return static_cast<int>(value);
}

double within(const std::string& text, double least, double most) {
  const double value = number(text);
  if (value >= least && value <= most) return value;
  throw Error(fmt::format("{} is not from {:g} to {:g}", text, least, most));
}

// Some kinds alone, and what families of sensors do in all.
void set_noise(SimulatedNoiseOptions& noise, const std::string& text) {
  constexpr std::array<std::string_view, 4> kKinds = {"none", "a", "b", "c"};
  const auto kind = std::ranges::find(kKinds, text);
  const std::uint64_t seed = noise.seed;
  if (kind != kKinds.end()) {
    noise.kind = static_cast<NoiseKind>(kind - kKinds.begin());
  } else if (text == "structured") {
    noise = {.kind = NoiseKind::quantised,
             .silhouettes = true,
             .seed = seed,
             .disparity_step = 1 / 8.0,
             .curl = 4e-3,
             .holes = 0.01};
  } else if (text == "stereo") {
    const double per_square = 0.08 / (525 * 0.075);  // 0.08 pixels of disparity, 1/m
    noise = {.kind = NoiseKind::blurred,
             .model = {.coefficients = {0, 0, per_square}},
             .silhouettes = true,
             .seed = seed,
             .disparity_step = 1 / 32.0,
             .curl = 6e-3,
             .holes = 0.02};
  } else if (text == "tof") {
    noise = {.model = {.coefficients = {1.5e-3, -0.5e-3, 0.3e-3}},
             .seed = seed,
             .mixed = 0.5,
             .pattern = 1e-3};
  } else {
    throw Error(fmt::format("'{}' is not one of none, a, b, c, structured, stereo and tof", text));
  }
}

// The same view with other pixels.
void set_width(CameraModel& camera, const std::string& text) {
  constexpr double kNarrowest = 8;  // pixels; six rows, which the depth filter needs
  constexpr double kWidest = 4096;  // pixels; as much as a remote camera may send (judgement)
  (void)within(text, kNarrowest, kWidest);
  const int width = whole(text);
  const double scale = static_cast<double>(width) / camera.width;
  camera.width = width;
  camera.height = static_cast<int>(std::lround(camera.height * scale));
  Pinhole& p = camera.pinhole;
  p = {p.fx * scale, p.fy * scale, (p.cx + 0.5) * scale - 0.5, (p.cy + 0.5) * scale - 0.5};
}

// The middle ray meets the table so far from its normal.
void tilt(SimulatedSetup& setup, double incidence) {
  Eigen::Isometry3d& pose = setup.camera.T_world_camera;
  const double now = std::acos(std::clamp(-pose.linear()(2, 2), -1.0, 1.0));
  pose = Eigen::AngleAxisd(incidence - now, Eigen::Vector3d(pose.linear().col(0))) * pose;
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
constexpr std::array<Key, 24> kKeys = {{
    {"noise", [](SimulatedSetup& s, Text v) { set_noise(s.camera.noise, v); }},
    {"sigma",
     [](SimulatedSetup& s, Text v) {
       s.camera.noise.model.coefficients = {within(v, 0, 0.1), 0, 0};
     }},
    {"terraces", [](SimulatedSetup& s, Text v) { s.camera.noise.disparity_step = number(v); }},
    {"curl", [](SimulatedSetup& s, Text v) { s.camera.noise.curl = number(v); }},
    {"mixed", [](SimulatedSetup& s, Text v) { s.camera.noise.mixed = number(v); }},
    {"pattern", [](SimulatedSetup& s, Text v) { s.camera.noise.pattern = number(v); }},
    {"correlation",
     [](SimulatedSetup& s, Text v) { s.camera.noise.correlation = within(v, 0, 30); }},
    {"smoothing", [](SimulatedSetup& s, Text v) { s.camera.noise.smoothing = whole(v); }},
    {"hops", [](SimulatedSetup& s, Text v) { s.camera.noise.hops = number(v); }},
    {"holes", [](SimulatedSetup& s, Text v) { s.camera.noise.holes = number(v); }},
    {"seed",
     [](SimulatedSetup& s, Text v) { s.camera.noise.seed = static_cast<std::uint64_t>(whole(v)); }},
    {"silhouettes", [](SimulatedSetup& s, Text v) { s.camera.noise.silhouettes = whole(v) != 0; }},
    {"rate", [](SimulatedSetup& s, Text v) { s.camera.rate = number(v); }},
    {"phase", [](SimulatedSetup& s, Text v) { s.camera.phase = number(v); }},
    {"jitter", [](SimulatedSetup& s, Text v) { s.camera.jitter = number(v); }},
    {"dropped", [](SimulatedSetup& s, Text v) { s.camera.dropped = number(v); }},
    {"repeat", [](SimulatedSetup& s, Text v) { s.camera.repeated = number(v); }},
    {"jump", [](SimulatedSetup& s, Text v) { s.camera.jump = number(v); }},
    {"frames", [](SimulatedSetup& s, Text v) { s.camera.frames = whole(v); }},
    {"loop", [](SimulatedSetup& s, Text v) { s.camera.loop = whole(v); }},
    {"view", [](SimulatedSetup& s, Text v) { turn_about_vertical(s, kDegree * number(v)); }},
    {"tilt", [](SimulatedSetup& s, Text v) { tilt(s, kDegree * within(v, 0, 90)); }},
    {"width", [](SimulatedSetup& s, Text v) { set_width(s.camera.camera, v); }},
    {"error",
     [](SimulatedSetup& s, Text v) {
       // 1 mm goes with 1/6 degree, as 3 mm with 0.5 degrees.
       const double meters = number(v);
       s.camera.T_camera_reported =
           calibration_error(meters, kDegree * meters / 0.006, s.camera.noise.seed);
     }},
}};

std::string key_list() {
  std::string text;
  for (const Key& key : kKeys) text += (text.empty() ? "" : ", ") + std::string(key.name);
  return text;
}

// Reports of which key a bad value was.
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
    throw Error(fmt::format("a simulated camera takes KEY=VALUE, not '{}'; the keys are {}",
                            assignment, key_list()));
  }
  const std::string name = assignment.substr(0, equals);
  for (const Key& key : kKeys) {
    if (name == key.name) return set(setup, key, assignment.substr(equals + 1));
  }
  throw Error(fmt::format("a simulated camera has no key '{}'; the keys are {}", name, key_list()));
}

}  // namespace palpate
