#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>
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
#include "session/tool_json.hpp"

/// Options as JSON and back, bit for bit, by what describe() lists of them. members() names those
/// of structs that are no options; a member that is new there does not compile before it is named
/// here.
namespace palpate::session {

/// Objects keep their keys in the order in which they are written.
using Json = nlohmann::ordered_json;

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
    for (int i = 0; i < 12; ++i) json.push_back(value.matrix()(i / 4, i % 4));
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

/// A value in an error's words: what is deep or long comes from a file that nobody trusts.
[[nodiscard]] inline std::string brief(const Json& json) {
  if (!json.is_string() && !json.is_number()) return json.type_name();
  constexpr std::size_t kMost = 80;  // characters, as many as a line of a terminal has
  const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
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

/// Reads what exact_json() wrote. @throws Error when a choice is unknown, nlohmann::json::exception
/// when it is something else.
template <class T>
void take_exact(const Json& json, T& value) {
  if constexpr (std::is_same_v<T, double>) {
    value = json.is_string() ? std::strtod(json.get<std::string>().c_str(), nullptr)
                             : json.get<double>();
  } else if constexpr (std::is_enum_v<T>) {
    value = choice_in<T>(json);
  } else if constexpr (IsOptional<T>::value) {
    value.reset();
    if (!json.is_null()) take_exact(json, value.emplace());
  } else if constexpr (std::is_same_v<T, std::shared_ptr<const Tool>>) {
    value = tool_in(json);
  } else if constexpr (Numbers<T>) {
    for (std::size_t i = 0; i < 3; ++i) take_exact(json.at(i), value.data()[i]);
  } else if constexpr (std::is_same_v<T, Eigen::Isometry3d>) {
    value.setIdentity();
    for (int i = 0; i < 12; ++i)
      take_exact(json.at(static_cast<std::size_t>(i)), value.matrix()(i / 4, i % 4));
  } else if constexpr (Described<T> || Listed<T>) {
    // What older recordings do not contain keeps its default, which is how they were made.
    const auto& object = json.template get_ref<const Json::object_t&>();
    const auto take = [&object](const char* name, auto& member) {
      if (const auto found = object.find(name); found != object.end()) {
        take_exact(found->second, member);
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
  } else {
    value = json.get<T>();
  }
}

}  // namespace palpate::session
