#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>

#include "apps/palpate/cli/output.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/device/device.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/servo/servo.hpp"

/// Options as JSON and back, bit for bit. members() names the members of each struct once; a member
/// that is new there does not compile before it is named here.
namespace palpate::app {

// `f` is handed the names and then the members, in one order.
void members(auto f, Pinhole& o) {
  auto& [fx, fy, cx, cy] = o;
  f({"fx", "fy", "cx", "cy"}, fx, fy, cx, cy);
}
void members(auto f, CameraModel::Distortion& o) {
  auto& [k1, k2, p1, p2, k3] = o;
  f({"k1", "k2", "p1", "p2", "k3"}, k1, k2, p1, p2, k3);
}
void members(auto f, CameraModel& o) {
  auto& [width, height, pinhole, distortion] = o;
  f({"width", "height", "pinhole", "distortion"}, width, height, pinhole, distortion);
}
void members(auto f, Friction& o) {
  auto& [resting, dynamic, viscous] = o;
  f({"static", "dynamic", "viscous"}, resting, dynamic, viscous);
}
void members(auto f, Texture& o) {
  auto& [amplitude, wavelength] = o;
  f({"amplitude", "wavelength"}, amplitude, wavelength);
}
void members(auto f, ContactSettings& o) {
  auto& [stiffness, friction, texture] = o;
  f({"stiffness", "friction", "texture"}, stiffness, friction, texture);
}
void members(auto f, FieldOptions& o) {
  auto& [kind, kernel, gradient, threshold, support, tool, capped, sharp, raw, nearest] = o;
  f({"kind", "kernel", "gradient", "threshold", "minimum_support", "tool_radius", "capped",
     "sharp_edges", "raw_weights", "nearest_radius"},
    kind, kernel, gradient, threshold, support, tool, capped, sharp, raw, nearest);
}
void members(auto f, ProxyOptions& o) {
  auto& [stiffness, friction, texture, method, iterations, tolerance, rise] = o;
  f({"stiffness", "friction", "texture", "method", "max_iterations", "tangent_tolerance",
     "rise_time"},
    stiffness, friction, texture, method, iterations, tolerance, rise);
}
void members(auto f, GuardOptions::Passivity& o) {
  auto& [on, mass, memory, forget, delay] = o;
  f({"on", "mass", "memory", "forget", "delay"}, on, mass, memory, forget, delay);
}
void members(auto f, GuardOptions& o) {
  auto& [on, force, slew, damping, silence, start, share, passivity] = o;
  f({"on", "maximum_force", "slew", "damping", "silence", "soft_start", "stiffness_share",
     "passivity"},
    on, force, slew, damping, silence, start, share, passivity);
}
void members(auto f, Workspace& o) {
  auto& [pose, scale] = o;
  f({"T_world_device", "scale"}, pose, scale);
}
void members(auto f, ServoOptions& o) {
  auto& [field, proxy, guard, workspace, clutch, steps, traces] = o;
  f({"field", "proxy", "guard", "workspace", "clutch_button"}, field, proxy, guard, workspace,
    clutch);
}
void members(auto f, DeviceInfo& o) {
  auto& [name, force, stiffness, damping, mass, rate, delay, radius, keeps, turns, grips] = o;
  f({"name", "maximum_force", "maximum_stiffness", "damping", "mass", "rate", "delay",
     "workspace_radius", "keeps_time", "has_orientation", "has_gripper"},
    name, force, stiffness, damping, mass, rate, delay, radius, keeps, turns, grips);
}
void members(auto f, Box& o) {
  f({"lower", "upper"}, o.lower, o.upper);
}
void members(auto f, Noise& o) {
  auto& [sigma, excess, shared] = o;
  f({"sigma", "excess", "shared"}, sigma, excess, shared);
}
void members(auto f, CloudFacts& o) {
  auto& [spacing, noise, lines, extent, radius] = o;
  f({"spacing", "noise", "in_lines", "extent", "radius"}, spacing, noise, lines, extent, radius);
}
void members(auto f, PrepareOptions& o) {
  auto& [voxel, radius, smoothing, least, error, viewpoint, signs, clip, speckle, normals, material,
         paper, kernel, facts, without] = o;  // the last is for benches alone
  f({"voxel", "radius", "smoothing", "minimum_radius", "normal_error", "viewpoint", "orientation",
     "clip", "remove_speckle", "estimate_normals", "material_from_intensity", "paper", "kernel",
     "facts"},
    voxel, radius, smoothing, least, error, viewpoint, signs, clip, speckle, normals, material,
    paper, kernel, facts);
}
void members(auto f, SourceOptions::SoftMaterial& o) {
  auto& [stiffness, friction] = o;
  f({"stiffness_factor", "friction_factor"}, stiffness, friction);
}
void members(auto f, PolicyOptions& o) {
  auto& [policy, history, silence, fade, everywhere, clips] = o;
  f({"policy", "history", "silence", "fade", "fit_everywhere", "clip_to_reach"}, policy, history,
    silence, fade, everywhere, clips);
}
void members(auto f, NoiseModel& o) {
  auto& [coefficients, correlation] = o;
  f({"coefficients", "correlation"}, coefficients, correlation);
}
void members(auto f, DepthFilterOptions& o) {
  auto& [noise, error, memory, nearest, farthest] = o;
  f({"noise", "normal_error", "memory", "nearest", "farthest"}, noise, error, memory, nearest,
    farthest);
}
void members(auto f, SourceOptions& o) {
  auto& [pose, prepare, soft, policy, depth, organised] = o;
  f({"T_world_sensor", "prepare", "soft", "policy", "depth", "organised"}, pose, prepare, soft,
    policy, depth, organised);
}

struct Unlisted {
  void operator()(std::initializer_list<const char*> /*names*/, auto&... /*members*/) const {}
};
template <class T>
concept Listed = requires(T& value) {
  members(Unlisted(), value);
};
template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
concept Numbers = std::is_same_v<T, Eigen::Vector3d> || std::is_same_v<T, std::array<double, 3>>;

/// Numbers that JSON has not are written as texts: "inf".
template <class T>
[[nodiscard]] Json exact_json(const T& value) {
  Json json;
  if constexpr (std::is_same_v<T, double>) {
    json = std::isfinite(value) ? Json(value) : Json(fmt::format("{}", value));
  } else if constexpr (std::is_enum_v<T>) {
    json = static_cast<int>(value);
  } else if constexpr (kIsOptional<T>) {
    if (value) json = exact_json(*value);
  } else if constexpr (Numbers<T>) {
    for (const double number : value) json.push_back(exact_json(number));
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    for (int i = 0; i < 12; ++i) json.push_back(value.matrix()(i / 4, i % 4));
  } else if constexpr (Listed<T>) {
    T copy = value;
    members(
        [&](std::initializer_list<const char*> names, const auto&... member) {
          const char* const* name = names.begin();
          ((json[*name++] = exact_json(member)), ...);
        },
        copy);
  } else {
    json = value;
  }
  return json;
}

/// Reads what exact_json() wrote. @throws nlohmann::json::exception when it is something else.
template <class T>
void take_exact(const Json& json, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    value = json.is_string() ? std::strtod(json.get<std::string>().c_str(), nullptr)
                             : json.get<double>();
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(json.get<int>());
  } else if constexpr (kIsOptional<T>) {
    value.reset();
    if (!json.is_null()) take_exact(json, value.emplace());
  } else if constexpr (Numbers<T>) {
    for (std::size_t i = 0; i < 3; ++i) take_exact(json.at(i), value.data()[i]);
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    value.setIdentity();
    for (int i = 0; i < 12; ++i)
      take_exact(json.at(static_cast<std::size_t>(i)), value.matrix()(i / 4, i % 4));
  } else if constexpr (Listed<T>) {
    // What older recordings do not know keeps its default, which is how they were made.
    const auto& object = json.template get_ref<const Json::object_t&>();
    const auto take = [&object](const char* name, auto& member) {
      if (const auto found = object.find(name); found != object.end()) {
        take_exact(found->second, member);
      }
    };
    members(
        [&](std::initializer_list<const char*> names, auto&... member) {
          const char* const* name = names.begin();
          (take(*name++, member), ...);
        },
        value);
  } else {
    value = json.get<T>();
  }
}

}  // namespace palpate::app
