#include "apps/palpate/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "apps/palpate/errors.hpp"

namespace palpate::app {

namespace {

std::optional<double> number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

// An argument's own name, if it has one.
std::optional<CloudArgument> split_name(const std::string& argument) {
  std::error_code ignored;
  if (std::filesystem::exists(argument, ignored)) return {};
  const std::size_t place = argument.find('=');
  if (place == std::string::npos || !is_name(std::string_view(argument).substr(0, place)))
    return {};
  return CloudArgument{argument.substr(0, place), argument.substr(place + 1)};
}

std::string name_of_path(const std::string& path) {
  if (path == "-") return "stdin";
  if (path.starts_with("synthetic:")) return path.substr(std::string("synthetic:").size());
  std::filesystem::path name = std::filesystem::path(path).filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().empty() ? "cloud" : name.stem().string();
}

std::string free_name(const std::string& wanted, const std::set<std::string>& taken) {
  std::string name = wanted;
  for (int i = 2; taken.contains(name); ++i) name = fmt::format("{}-{}", wanted, i);
  return name;
}

}  // namespace

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& option, const std::string& form) {
  std::vector<double> values;
  std::string_view rest = text;
  while (true) {
    const std::size_t end = rest.find(',');
    const std::optional<double> value = number(rest.substr(0, end));
    if (!value) {
      throw UsageError(fmt::format("{}: '{}' is not a finite number in '{}'; write {}", option,
                                   rest.substr(0, end), text, form));
    }
    values.push_back(*value);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (values.size() != count) {
    throw UsageError(fmt::format("{}: '{}' has {} numbers instead of {}; write {}", option, text,
                                 values.size(), count, form));
  }
  return values;
}

Eigen::Vector3d parse_point(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_numbers(text, 3, option, "x,y,z in metres, such as 0,0,1.2");
  return {v[0], v[1], v[2]};
}

Pinhole parse_intrinsics(const std::string& text) {
  const std::vector<double> v =
      parse_numbers(text, 4, "--intrinsics", "fx,fy,cx,cy in pixels, such as 525,525,319.5,239.5");
  if (v[0] <= 0 || v[1] <= 0) {
    throw UsageError(fmt::format("--intrinsics: focal lengths {}, {} must be above 0", v[0], v[1]));
  }
  return {v[0], v[1], v[2], v[3]};
}

PoseArgument parse_pose(const std::string& text) {
  const std::string form = "NAME=x,y,z,qx,qy,qz,qw in metres and as a unit quaternion";
  const std::size_t place = text.find('=');
  if (place == std::string::npos || place == 0) {
    throw UsageError(fmt::format("--pose: '{}' names no cloud; write {}", text, form));
  }
  const std::vector<double> v = parse_numbers(text.substr(place + 1), 7, "--pose", form);
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1) > 0.01) {
    throw UsageError(
        fmt::format("--pose {}: the quaternion's length is {:.4g}; it must be 1 (the "
                    "order is qx,qy,qz,qw)",
                    text.substr(0, place), rotation.norm()));
  }
  PoseArgument result;
  result.name = text.substr(0, place);
  result.pose = Eigen::Translation3d(v[0], v[1], v[2]) * rotation.normalized();
  return result;
}

std::vector<CloudArgument> parse_clouds(const std::vector<std::string>& arguments) {
  std::vector<CloudArgument> clouds(arguments.size());
  std::set<std::string> taken;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::optional<CloudArgument> named = split_name(arguments[i]);
    clouds[i] = named ? *named : CloudArgument{"", arguments[i]};
    if (named && !taken.insert(named->name).second) {
      throw UsageError(
          fmt::format("two clouds are named '{}'; give each its own name", named->name));
    }
  }
  for (CloudArgument& cloud : clouds) {
    if (!cloud.name.empty()) continue;
    cloud.name = free_name(name_of_path(cloud.path), taken);
    taken.insert(cloud.name);
  }
  const auto standard_input = [](const CloudArgument& cloud) { return cloud.path == "-"; };
  if (std::ranges::count_if(clouds, standard_input) > 1) {
    throw UsageError("standard input (-) can be read only once");
  }
  return clouds;
}

}  // namespace palpate::app
