// Parses what is named on the command line: sources, poses, numbers.
#include "apps/palpate/cli/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/matrix_pose.hpp"
#include "io/input.hpp"
#include "palpate/base/error.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "sensor/bag_topics.hpp"

namespace palpate::app {
namespace {

std::optional<double> number_in(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

// "simulated:table,rate=60" is called simulated-table.
std::string name_of_camera(std::string_view text) {
  if (text.starts_with("remote:")) return "remote";  // whatever its socket is called
  std::string name;
  for (const char c : text.substr(0, text.find(','))) {
    const bool fits = is_name({&c, 1});
    if (fits) name += c;
    if (!fits && !name.empty() && name.back() != '-') name += '-';
  }
  while (name.ends_with('-')) name.pop_back();
  return name.empty() ? "camera" : name;
}

std::string name_of_path(const std::string& path) {
  if (path == "-") return "stdin";
  if (path.starts_with(kSynthetic)) return path.substr(kSynthetic.size());
  if (path.starts_with(kCamera)) return name_of_camera(path.substr(kCamera.size()));
  std::filesystem::path file(path);
  if (path.starts_with(kSequence)) file = path.substr(kSequence.size());
  if (path.starts_with(kRos)) file = path.substr(0, path.find(','));
  if (path.starts_with(kBag)) file = file_of(path);
  if (file.filename() == "metadata.json") file = file.parent_path();  // of a Potree store
  if (!file.has_filename()) file = file.parent_path();  // a folder with a slash behind it
  std::filesystem::path name = file.filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().empty() ? "cloud" : name.stem().string();
}

std::string free_name(const std::string& wanted, const std::set<std::string>& taken) {
  std::string name = wanted;
  for (int i = 2; taken.contains(name); ++i) name = fmt::format("{}-{}", wanted, i);
  return name;
}

}  // namespace

std::string file_of(const std::string& source) {
  if (!source.starts_with(kBag)) return io::split_scan(source).file;
  return sensor::bag_file(source.substr(kBag.size()));
}

std::vector<double> parse_numbers(const std::string& text, std::size_t count,
                                  const std::string& option, const std::string& form) {
  std::vector<double> values;
  std::string_view rest = text;
  while (true) {
    const std::size_t end = rest.find(',');
    const std::optional<double> value = number_in(rest.substr(0, end));
    if (!value) {
      const std::string_view wrong = rest.substr(0, end);
      const std::string where = wrong == text ? "" : fmt::format(" in '{}'", text);
      throw UsageError(
          fmt::format("{}: '{}' is not a finite number{}; write {}", option, wrong, where, form));
    }
    values.push_back(*value);
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (count > 0 && values.size() != count) {
    throw UsageError(fmt::format("{}: '{}' has {} number{} instead of {}; write {}", option, text,
                                 values.size(), values.size() == 1 ? "" : "s", count, form));
  }
  return values;
}

Eigen::Vector3d parse_point(const std::string& text, const std::string& option) {
  const std::vector<double> v = parse_numbers(text, 3, option, "x,y,z in metres, e.g. 0,0,1.2");
  return {v[0], v[1], v[2]};
}

Pinhole parse_intrinsics(const std::string& text) {
  const std::vector<double> v =
      parse_numbers(text, 4, "--intrinsics", "fx,fy,cx,cy in pixels, e.g. 525,525,319.5,239.5");
  if (v[0] <= 0 || v[1] <= 0) {
    throw UsageError(fmt::format("--intrinsics: focal lengths {}, {} must be above 0", v[0], v[1]));
  }
  return {v[0], v[1], v[2], v[3]};
}

NoiseModel parse_noise(const std::string& text) {
  if (std::ranges::none_of(text, [](char c) { return c == ','; })) {
    try {
      return sensor_noise(text);
    } catch (const Error& error) {
      throw UsageError(fmt::format("--noise: {}", error.what()));
    }
  }
  const auto commas = static_cast<std::size_t>(std::ranges::count(text, ','));
  const std::vector<double> v =
      parse_numbers(text, commas == 3 ? 4 : 3, "--noise",
                    "S0,S1,S2 or S0,S1,S2,C, e.g. 0.0012,0,0.0019 for 1.2 mm + 1.9 mm z^2");
  NoiseModel model;
  std::copy_n(v.begin(), 3, model.coefficients.begin());
  if (v.size() == 4) model.correlation = v[3];
  if (model.correlation < 1) {
    throw UsageError(fmt::format("--noise: the correlation {} is below 1; give 1 or more", v[3]));
  }
  return model;
}

Eigen::Isometry3d pose_of(const std::vector<double>& v, const std::string& what) {
  if (v.size() == 12 || v.size() == 16) return pose_of_matrix(v, what);
  if (v.size() != 7) {
    throw UsageError(
        fmt::format("{}: {} numbers are no pose; write {}", what, v.size(), kPoseForm));
  }
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
  if (std::abs(rotation.norm() - 1) > 0.01) {
    throw UsageError(fmt::format(
        "{}: the quaternion's length is {:.4g}; it must be 1 (the order is qx,qy,qz,qw)", what,
        rotation.norm()));
  }
  return Eigen::Translation3d(v[0], v[1], v[2]) * rotation.normalized();
}

PoseArgument parse_pose(const std::string& text) {
  const std::string form = std::string("NAME=") + kPoseForm;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("--pose: '{}' names no source; write {}", text, form));
  }
  const std::vector<double> v = parse_numbers(text.substr(equals + 1), 0, "--pose", form);
  const std::string name = text.substr(0, equals);
  return {name, pose_of(v, "--pose " + name)};
}

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

CloudArgument split_argument(const std::string& text) {
  std::error_code ignored;
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string::npos && !std::filesystem::exists(text, ignored) &&
                     is_name(std::string_view(text).substr(0, equals));
  return named ? CloudArgument{text.substr(0, equals), text.substr(equals + 1)}
               : CloudArgument{"", text};
}

bool lives(const std::string& path) {
  return path.starts_with(kCamera) || path.starts_with(kSequence) || path.starts_with(kBag) ||
         path.starts_with(kRos) || path.ends_with(".oni");
}

bool names_something(const std::string& path) {
  return !path.empty() && path != kCamera && path != kSequence && path != kBag && path != kRos &&
         path != kSynthetic;
}

void name_all(std::vector<CloudArgument>& sources) {
  for (const CloudArgument& source : sources) {
    if (names_something(source.path)) continue;
    throw UsageError(fmt::format(
        "'{}' names no source; give a file path, camera:NAME, sequence:FOLDER, bag:FILE, ros:TOPIC "
        "or synthetic:NAME",
        source.path));
  }
  std::set<std::string> taken;
  for (const CloudArgument& source : sources) {
    if (source.name.empty() || taken.insert(source.name).second) continue;
    throw UsageError(
        fmt::format("two sources are named '{}'; give each its own name", source.name));
  }
  for (CloudArgument& source : sources) {
    if (!source.name.empty()) continue;
    source.name = free_name(name_of_path(source.path), taken);
    taken.insert(source.name);
  }
  const auto standard_input = [](const CloudArgument& source) { return source.path == "-"; };
  if (std::ranges::count_if(sources, standard_input) > 1) {
    throw UsageError("standard input (-) can be read only once; give a file for the other input");
  }
}

std::vector<CloudArgument> parse_clouds(const std::vector<std::string>& arguments) {
  std::vector<CloudArgument> clouds(arguments.size());
  std::ranges::transform(arguments, clouds.begin(), split_argument);
  name_all(clouds);
  return clouds;
}

std::string without_option(const std::string& message) {
  const std::size_t end = message.find(": ");
  return message.starts_with("--") && end != std::string::npos ? message.substr(end + 2) : message;
}

std::string wrapped(const std::string& text) {
  constexpr std::size_t kWidth = 66;
  std::string result;
  std::size_t begin = 0;
  while (text.size() - begin > kWidth) {
    const std::size_t space = text.rfind(' ', begin + kWidth);
    if (space == std::string::npos || space <= begin) break;
    result += text.substr(begin, space - begin) + '\n';
    begin = space + 1;
  }
  return result + text.substr(begin);
}

}  // namespace palpate::app
