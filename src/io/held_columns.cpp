// Finds the columns of a trajectory that say how a tool is held.
#include "io/held_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::array<std::string_view, 4> kQuaternion{"qx", "qy", "qz", "qw"};
constexpr std::array<std::string_view, 3> kAngles{"roll", "pitch", "yaw"};

// "pose.orientation.x" has three.
std::vector<std::string_view> parts_of(std::string_view name) {
  constexpr std::string_view kBetween = "._/ -[](){}:";
  std::vector<std::string_view> words;
  for (std::size_t at = name.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(name.find_first_of(kBetween, at), name.size());
    words.push_back(name.substr(at, end - at));
    at = name.find_first_not_of(kBetween, end);
  }
  return words;
}

// A number of a quaternion: which of x, y, z, w it is, and its name without that letter.
struct Part {
  std::string stem;
  std::size_t axis = 0;
};

// The letter of an axis that a word ends with behind a word for orientations: "qx", "orientationx".
std::optional<char> axis_in(std::string_view word) {
  constexpr std::array<std::string_view, 5> kBefore{"q", "quat", "quaternion", "orientation",
                                                    "rotation"};
  if (word.empty()) return {};
  const std::string_view before = word.substr(0, word.size() - 1);
  return std::ranges::count(kBefore, before) > 0 ? std::optional(word.back()) : std::nullopt;
}

// "pose.orientation.x", "qx_world_device", "quat_x"; not those of a log's tool, which stays outside
// of what it touches.
std::optional<Part> part_of(const std::string& name) {
  const std::vector<std::string_view> words = parts_of(name);
  if (words.empty() || words[0] == "tool" || words[0] == "proxy") return {};
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::optional<char> axis = axis_in(words[i]);
    std::size_t at = static_cast<std::size_t>(words[i].data() - name.data()) + words[i].size() - 1;
    if (!axis && i + 1 == words.size() && i > 0 && words[i].size() == 1 &&
        axis_in(std::string(words[i - 1]) + "x")) {
      axis = words[i][0];
    }
    const std::size_t number = std::string_view("xyzw").find(axis.value_or('-'));
    if (number == std::string_view::npos) continue;
    Part part{name, number};
    part.stem[at] = '?';
    return part;
  }
  return {};
}

std::optional<HeldColumns> named_plainly(std::span<const std::string_view> names) {
  HeldColumns held;
  for (std::size_t k = 0; k < kQuaternion.size(); ++k) {
    const auto found = std::ranges::find(names, kQuaternion[k]);
    if (found == names.end()) return {};
    held.slots[k] = static_cast<std::size_t>(found - names.begin());
  }
  return held;
}

FoundColumns quaternion_in(std::span<const std::string_view> names) {
  std::map<std::string, std::array<std::optional<std::size_t>, 4>> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto part = part_of(lower_case(names[i]));
    if (part) found[part->stem][part->axis] = i;
  }
  std::erase_if(found, [](const auto& each) {
    return std::ranges::any_of(each.second, [](const auto& slot) { return !slot; });
  });
  if (found.empty()) return {};
  HeldColumns held;
  for (std::size_t k = 0; k < held.slots.size(); ++k) {
    held.slots[k] = *found.begin()->second[k];
    held.words += fmt::format("{}{}", k > 0 ? ", " : "", names[held.slots[k]].substr(0, 40));
  }
  if (found.size() == 1) return {held, {}};
  const auto& second = std::next(found.begin())->second;
  return {{},
          fmt::format("two orientations, {} and {}: name the columns of the tool's one qx,qy,qz,qw",
                      names[held.slots[0]].substr(0, 40), names[*second[0]].substr(0, 40))};
}

FoundColumns angles_in(std::span<const std::string_view> names) {
  HeldColumns held{.angles = true};
  enum class Found { no, prefixed, plainly };  // "hand_roll", "roll"
  std::array<Found, 3> found{};
  std::array<bool, 3> in_degrees{};
  std::array<bool, 3> in_radians{};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(names[i]);
    const std::vector<std::string_view> words = parts_of(name);
    for (std::size_t k = 0; k < kAngles.size(); ++k) {
      const auto at = std::ranges::find(words, kAngles[k]);
      if (at == words.end() || words[0] == "tool") continue;
      const std::string_view unit = at + 1 == words.end() ? "" : *(at + 1);
      const bool degrees = unit.starts_with("deg") || unit == "\xc2\xb0";
      const bool radians = unit.starts_with("rad");
      if (!unit.empty() && !degrees && !radians) continue;  // "roll_rate"
      const Found how = at == words.begin() ? Found::plainly : Found::prefixed;
      if (how < found[k]) continue;
      if (how == found[k]) {
        return {{}, fmt::format("two columns of {0}: call the one of the tool {0}", kAngles[k])};
      }
      found[k] = how;
      held.slots[k] = i;
      in_degrees[k] = degrees;
      in_radians[k] = radians;
    }
  }
  if (std::ranges::count(found, Found::no) > 0) return {};
  const bool degrees = std::ranges::count(in_degrees, true) > 0;
  const bool radians = std::ranges::count(in_radians, true) > 0;
  if (degrees && radians) {
    return {{},
            "roll, pitch and yaw are partly in radians and partly in degrees: bring them to one"};
  }
  if (degrees) held.unit = std::numbers::pi / 180;
  held.stated = degrees || radians;
  held.words = fmt::format("roll, pitch and yaw {} {}", held.stated ? "in" : "taken as",
                           held.unit == 1 ? "radians" : "degrees");
  return {held, {}};
}

}  // namespace

Eigen::Quaterniond HeldColumns::orientation(const std::array<double, 4>& numbers) const {
  if (!angles) return {numbers[3], numbers[0], numbers[1], numbers[2]};
  using Turn = Eigen::AngleAxisd;
  return Turn(numbers[2] * unit, Eigen::Vector3d::UnitZ()) *
         Turn(numbers[1] * unit, Eigen::Vector3d::UnitY()) *
         Turn(numbers[0] * unit, Eigen::Vector3d::UnitX());
}

FoundColumns find_held_columns(std::span<const std::string_view> names) {
  if (const auto plain = named_plainly(names)) return {plain, {}};
  const bool begun = std::ranges::any_of(
      kQuaternion, [&](std::string_view name) { return std::ranges::count(names, name) > 0; });
  if (begun) {
    return {{}, "an orientation has four columns, qx,qy,qz,qw: name all of them, or none"};
  }
  FoundColumns found = quaternion_in(names);
  return found.columns || !found.problem.empty() ? found : angles_in(names);
}

}  // namespace palpate::io
