#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "message/cdr.hpp"

namespace palpate::message {

/// Quality of service that a topic requests or offers (docs/ros2.md).
struct Quality {
  bool reliable = false;  ///< lost messages are sent again
  int depth = 1;          ///< newest messages that are kept
  bool stays = false;     ///< late readers get what was written before ("transient local")
};

/// "sensor_msgs/msg/Image", as ROS 2 and bags name a type whose kName is "sensor_msgs/Image".
[[nodiscard]] inline std::string ros_name(std::string name) {
  return name.insert(name.find('/'), "/msg");
}

/// "sensor_msgs::msg::dds_::Image_", as ROS 2 names it on DDS.
[[nodiscard]] inline std::string dds_name(const std::string& name) {
  const std::size_t slash = name.find('/');
  return name.substr(0, slash) + "::msg::dds_::" + name.substr(slash + 1) + "_";
}

template <class T>
struct Definition;  // how a .msg file writes the type T

/// A type in the words of .msg files, and what it is made of.
template <Number T>
struct Definition<T> {
  static std::string type() {
    if constexpr (std::is_same_v<T, bool>) return "bool";
    if constexpr (std::is_same_v<T, std::byte>) return "byte";
    if constexpr (std::is_floating_point_v<T>) return fmt::format("float{}", 8 * sizeof(T));
    return fmt::format("{}int{}", std::is_unsigned_v<T> ? "u" : "", 8 * sizeof(T));
  }
  static void parts(auto&&) {}
};

template <>
struct Definition<std::string> {
  static std::string type() { return "string"; }
  static void parts(auto&&) {}
};

template <class T>
struct Definition<std::vector<T>> {
  static std::string type() { return Definition<T>::type() + "[]"; }
  static void parts(auto&& take) { Definition<T>::parts(take); }
};

template <class T, std::size_t N>
struct Definition<std::array<T, N>> {
  static std::string type() { return fmt::format("{}[{}]", Definition<T>::type(), N); }
  static void parts(auto&& take) { Definition<T>::parts(take); }
};

template <Message T>
struct Definition<T> {
  inline static const T kEmpty{};

  static std::string type() { return T::kName; }

  static std::string text() {
    std::string lines;
    T::each(kEmpty, [&]<class Member>(const char* name, const Member&) {
      lines += fmt::format("{} {}\n", Definition<Member>::type(), name);
    });
    return lines;
  }

  // Itself and, once each, all messages within it.
  static void parts(auto&& take) {
    if (!take(T::kName, text())) return;
    T::each(kEmpty,
            [&]<class Member>(const char*, const Member&) { Definition<Member>::parts(take); });
  }
};

/// The definition of a message and, behind it, of all that it is made of, as rosbags hold it
/// ("ros2msg").
template <Message T>
[[nodiscard]] std::string schema_of() {
  std::string schema;
  std::vector<std::string> seen;
  Definition<T>::parts([&](const char* name, const std::string& text) {
    if (std::ranges::find(seen, name) != seen.end()) return false;
    if (!seen.empty()) schema += std::string(80, '=') + "\nMSG: " + name + "\n";
    seen.emplace_back(name);
    schema += text;
    return true;
  });
  return schema;
}

}  // namespace palpate::message
