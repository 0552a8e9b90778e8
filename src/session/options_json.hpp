#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "contact/description.hpp"
#include "depth/description.hpp"
#include "palpate/base/error.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/servo.hpp"
#include "prepare/description.hpp"
#include "scene/description.hpp"
#include "servo/description.hpp"
#include "session/json_numbers.hpp"
#include "session/tool_json.hpp"

/// Options as JSON and back, bit for bit, by what describe() lists of them. members() names those
/// of structs that are no options; a member that is new there does not compile before it is named
/// here.
namespace palpate::session {

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
void members(auto f, ContactSettings& o) {
  auto& [stiffness, friction, texture] = o;
  f({"stiffness", "friction", "texture"}, stiffness, friction, texture);
}
void members(auto f, Workspace& o) {
  auto& [pose, scale] = o;
  f({"T_world_device", "scale"}, pose, scale);
}
void members(auto f, ServoOptions& o) {
  auto& [field, proxy, tool, gyration, guard, workspace, clutch, steps, traces] = o;
  f({"field", "proxy", "tool", "gyration", "guard", "workspace", "clutch_button"}, field, proxy,
    tool, gyration, guard, workspace, clutch);
}
void members(auto f, DeviceInfo& o) {
  auto& [name, force, stiffness, damping, mass, torque, grip, turn_damping, inertia, rate, delay,
         radius, keeps, turns, grips] = o;
  f({"name", "maximum_force", "maximum_stiffness", "damping", "mass", "maximum_torque",
     "maximum_grip", "angular_damping", "inertia", "rate", "delay", "workspace_radius",
     "keeps_time", "has_orientation", "has_gripper"},
    name, force, stiffness, damping, mass, torque, grip, turn_damping, inertia, rate, delay, radius,
    keeps, turns, grips);
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
void members(auto f, SourceOptions::SoftMaterial& o) {
  auto& [stiffness, friction] = o;
  f({"stiffness_factor", "friction_factor"}, stiffness, friction);
}
void members(auto f, NoiseModel& o) {
  auto& [coefficients, correlation] = o;
  f({"coefficients", "correlation"}, coefficients, correlation);
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
concept Numbers = std::is_same_v<T, Eigen::Vector3d> || std::is_same_v<T, std::array<double, 3>>;

/// Numbers that JSON has not are written as texts: "inf".
template <class T>
[[nodiscard]] Json exact_json(const T& value) {
  Json json;
  if constexpr (std::is_same_v<T, double>) {
    json = std::isfinite(value) ? Json(value) : Json(fmt::format("{}", value));
  } else if constexpr (std::is_enum_v<T>) {
    json = name_in(choices(value), value);
  } else if constexpr (IsOptional<T>::value) {
    if (value) json = exact_json(*value);
  } else if constexpr (std::is_same_v<T, std::shared_ptr<const Tool>>) {
    if (value) json = tool_json(*value);
  } else if constexpr (Numbers<T>) {
    for (const double number : value) json.push_back(exact_json(number));
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    for (int i = 0; i < 12; ++i) json.push_back(exact_json(value.matrix()(i / 4, i % 4)));
  } else if constexpr (Described<const T>) {
    describe(value, [&json](const About& about, const auto& member) {
      json[about.name] = exact_json(member);
    });
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

/// A choice by its name, or, as earlier versions wrote it, by its number.
/// @throws Error when there is none of it.
template <class Choice>
[[nodiscard]] Choice choice_in(const Json& json) {
  const auto& table = choices(Choice());
  for (const Named<Choice>& each : table) {
    if (json == each.name || json == static_cast<int>(each.choice)) return each.choice;
  }
  throw Error(fmt::format("{} is none of {}", brief(json), fmt::join(names_of(table), ", ")));
}

template <class T>
void take_exact(const Json& json, T& value);

/// Reads the members of what has some.
template <class T>
void take_members(const Json& json, T& value) {
  // What older recordings do not contain keeps its default, which is how they were made.
  const auto& object = json.template get_ref<const Json::object_t&>();
  const auto take = [&object](const char* name, auto& member) {
    const auto found = object.find(name);
    if (found == object.end()) return;
    try {
      take_exact(found->second, member);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", name, error.what()));
    }
  };
  if constexpr (Described<T>) {
    describe(value, [&take](const About& about, auto& member) { take(about.name, member); });
  } else {
    members(
        [&](std::initializer_list<const char*> names, auto&... member) {
          const char* const* name = names.begin();
          (take(*name++, member), ...);
        },
        value);
  }
}

/// Reads what exact_json() wrote. @throws Error when it is another number, or of a choice that is
/// unknown; nlohmann::json::exception when it is something else.
template <class T>
void take_exact(const Json& json, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    value = number_in(json);
  } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
    value = whole_in<T>(json);
  } else if constexpr (std::is_enum_v<T>) {
    value = choice_in<T>(json);
  } else if constexpr (IsOptional<T>::value) {
    value.reset();
    if (!json.is_null()) take_exact(json, value.emplace());
  } else if constexpr (std::is_same_v<T, std::shared_ptr<const Tool>>) {
    value = tool_in(json);
  } else if constexpr (Numbers<T>) {
    require_size(json, 3);
    for (std::size_t i = 0; i < 3; ++i) take_exact(json[i], value.data()[i]);
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    require_size(json, 12);
    value.setIdentity();
    for (int i = 0; i < 12; ++i)
      take_exact(json[static_cast<std::size_t>(i)], value.matrix()(i / 4, i % 4));
  } else if constexpr (Described<T> || Listed<T>) {
    take_members(json, value);
  } else {
    value = json.get<T>();
  }
}

}  // namespace palpate::session
