// Guesses the units of files, and offers others.
#include "session/length_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "geometry/inner_box.hpp"
#include "io/units/file_unit.hpp"
#include "io/units/length_names.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::session {
namespace {

constexpr std::size_t kLookedAt = 200'000;  // points for the core
constexpr std::size_t kFewest = 50;         // points of which some can be called outliers
constexpr std::size_t kOutliers = 1000;     // one in so many may be, at either end

constexpr std::string_view kUnitKey = "unit.";

struct LengthUnit {
  const char* name;
  double metres;
};

constexpr std::array<LengthUnit, 5> kLengthUnits = {
    {{"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"inch", 0.0254}, {"ft", 0.3048}}};

std::string name_of_unit(double metres) {
  const auto unit = std::ranges::find_if(kLengthUnits, [metres](const LengthUnit& each) {
    return io::is_same_unit(metres, each.metres);
  });
  return unit == kLengthUnits.end() ? fmt::format("{:g} m", metres) : unit->name;
}

double farthest(const Box& bounds) {
  return std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
}

UnitsGuess survey_units(const Box& bounds) {
  const Eigen::Vector3d middle = bounds.center();
  const bool utm = middle.x() > 1e5 && middle.x() < 9e5 && middle.y() > 1.1e6 && middle.y() < 1e7;
  const std::string where =
      fmt::format("the points are around x = {:.0f}, y = {:.0f}", middle.x(), middle.y());
  if (utm) return {"metres", where + ", typical of UTM coordinates", ""};
  return {"metres or feet", where + ": survey coordinates, but outside the UTM range",
          "if they are feet (state-plane data often is), give --scale 0.3048"};
}

// What is to be said of a unit that the file states.
UnitsGuess stated_units(const FileUnit& unit) {
  const std::string name = io::name_of_length(unit.plan);
  UnitsGuess stated{name, fmt::format("the file says so by {}", unit.words), ""};
  if (!io::is_same_unit(unit.plan, unit.height)) {
    stated.units += ", heights in " + io::name_of_length(unit.height);
  }
  if (io::states_heights_alone(unit)) {
    stated.advice = fmt::format(
        "it says none of x and y, which are taken to be in {}: if they are in others, give "
        "--scale {:.12g},{:.12g}",
        name, io::other_plan(unit), unit.height);
  } else if (!unit.height_stated && !io::is_same_unit(unit.plan, 1)) {
    stated.advice = fmt::format(
        "it says none of heights, which are taken to be in {}, too: if they are in metres, give "
        "--scale {:.12g},1",
        name, unit.plan);
  }
  return stated;
}

// What is to be said of a unit that the size of a mesh makes likely.
UnitsGuess likely_units(const FileUnit& unit) {
  const bool metres = unit.plan == 1;
  return {io::name_of_length(unit.plan), unit.words,
          metres ? "if they are millimetres, give --scale 0.001"
                 : "if they are others, give --scale: 1 for metres, 0.01 for centimetres, 0.0254 "
                   "for inches, 0.3048 for feet",
          unit.plan};
}

}  // namespace

Box bounds_of(const PointCloud& cloud) {
  Box box;
  for (std::size_t i = 0; i < cloud.size(); ++i) box.extend(cloud.point(i));
  return box;
}

Box core_of(const PointCloud& cloud) {
  const Box all = bounds_of(cloud);
  if (cloud.size() < kFewest) return all;
  const std::size_t stride = cloud.size() / kLookedAt + 1;
  std::vector<Eigen::Vector3f> sample;
  for (std::size_t i = 0; i < cloud.size(); i += stride) sample.push_back(cloud.positions[i]);
  Box core = detail::inner_box(sample, (sample.size() - 1) / kOutliers + 1);
  core.lower += cloud.origin;
  core.upper += cloud.origin;
  return all.size().maxCoeff() > 2 * core.size().maxCoeff() ? core : all;
}

UnitsGuess guess_units(const Box& bounds, const std::string& format) {
  const double extent = bounds.size().maxCoeff();
  const std::string size = fmt::format("the longest side is {:.4g}", extent);
  if (const double far = farthest(bounds); far > Proxy::kLargestCoordinate) {
    return {"unknown",
            fmt::format("the points are {:.4g} from the origin; beyond {:.0e} m surfaces cannot be "
                        "resolved",
                        far, Proxy::kLargestCoordinate),
            "give --scale with the metres per unit of the file, or move the points"};
  }
  if (format.starts_with("glTF")) return {"metres", size + "; glTF is in metres", ""};
  if (io::is_survey(bounds)) return survey_units(bounds);
  if (format.starts_with("LAS") || format.starts_with("LAZ")) {
    return {"metres or feet", size + "; LAS files use either",
            "if they are feet, give --scale 0.3048"};
  }
  if (extent == 0) return {"unknown", "all points coincide", ""};
  if (extent > 400) {
    return {"millimetres",
            size + ": too long for a scanned room in metres, plausible in millimetres",
            "give --scale 0.001, unless it really is that large", 0.001};
  }
  if (extent > 60) {
    return {"metres or millimetres",
            size + ": outdoors in metres, or a small object in millimetres",
            "if it is an object, give --scale 0.001"};
  }
  if (extent < 0.004) {
    return {"unknown", size + ": very small for metres",
            "give --scale with the metres per unit of the file"};
  }
  return {"metres", size + ", plausible for an object or a room in metres", ""};
}

UnitsGuess units_of(const FileUnit& unit, const std::string& format, const Box& core) {
  using Source = FileUnit::Source;
  if (farthest(core) > Proxy::kLargestCoordinate) return guess_units(core, format);
  if (unit.source == Source::stated) return stated_units(unit);
  if (unit.source == Source::likely) return likely_units(unit);
  if (unit.source == Source::assumed) return guess_units(core, format);
  UnitsGuess given{"metres", "by the scale or the length that was given", ""};
  if (!unit.words.empty()) given.advice = unit.words + "; remove --scale to use that";
  return given;
}

UnitsGuess units_of(const CloudFile& file, const Box& core) {
  if (!file.splats || file.unit.source != FileUnit::Source::assumed) {
    return units_of(file.unit, file.format, core);
  }
  return {"unknown", fmt::format("{:.3g} long, and splats have no unit", core.size().maxCoeff()),
          "give --length with the metres of its longest side"};
}

ViewerControls::Setting unit_setting(const std::string& name, double metres,
                                     const std::optional<UnitQuestion>& question) {
  ViewerControls::Setting setting{.key = std::string(kUnitKey) + name, .label = "Unit of " + name};
  setting.kind = ViewerControls::Setting::Kind::choice;
  for (const LengthUnit& unit : kLengthUnits) setting.choices.emplace_back(unit.name);
  const std::string present = name_of_unit(metres);
  if (!std::ranges::count(setting.choices, present)) setting.choices.push_back(present);
  setting.value = present;
  setting.restarts = true;
  if (!question) return setting;
  const Eigen::Vector3d size = question->core.size() / metres;
  const auto words = [](double side) {
    return side < 999.5 ? fmt::format("{:.3g}", side) : fmt::format("{:.0f}", side);
  };
  setting.question = fmt::format("{}: {} x {} x {} {}?", name, words(size.x()), words(size.y()),
                                 words(size.z()), name_of_unit(question->likely));
  return setting;
}

std::optional<std::string> source_of_unit(std::string_view key) {
  if (!key.starts_with(kUnitKey)) return {};
  return std::string(key.substr(kUnitKey.size()));
}

std::optional<double> metres_of_unit(std::string_view name) {
  const auto unit = std::ranges::find(kLengthUnits, name, &LengthUnit::name);
  if (unit == kLengthUnits.end()) return {};
  return unit->metres;
}

}  // namespace palpate::session
