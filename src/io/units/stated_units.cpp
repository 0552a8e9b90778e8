// Finds the units of systems of coordinates that are described in text.
#include "io/units/stated_units.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "io/input.hpp"
#include "io/text_scanner.hpp"
#include "io/units/epsg.hpp"
#include "io/units/length_names.hpp"
#include "io/units/wkt.hpp"

namespace palpate::io {
namespace {

using Keywords = std::initializer_list<std::string_view>;

bool is_any(const WktNode& node, Keywords keywords) {
  return std::ranges::find(keywords, node.keyword) != keywords.end();
}

const WktNode* child_of(const WktNode& node, Keywords keywords) {
  const auto child = std::ranges::find_if(
      node.children, [&](const WktNode& each) { return is_any(each, keywords); });
  return child == node.children.end() ? nullptr : &*child;
}

// The code of AUTHORITY["EPSG","2225"] or ID["EPSG",2225]; 0: there is none.
unsigned epsg_code(const WktNode& node) {
  const WktNode* id = child_of(node, {"ID", "AUTHORITY"});
  if (id == nullptr || id->values.size() < 2) return 0;
  constexpr std::size_t kMostCode = 1'000'000;  // codes have five digits
  const std::size_t code = parse_count(trim(id->values[1])).value_or(0);
  return code < kMostCode ? static_cast<unsigned>(code) : 0;
}

// Metres, of UNIT["foot",0.3048,ID["EPSG",9002]]: by its factor, else by its code or its name.
std::optional<double> metres_in(const WktNode& unit) {
  if (unit.values.size() > 1) {
    const std::optional<double> factor = parse_number(trim(unit.values[1]));
    if (factor) return factor;
  }
  if (const auto known = metres_of_epsg_unit(epsg_code(unit))) return known;
  return unit.values.empty() ? std::nullopt : metres_of(unit.values[0]);
}

// Metres a unit of an axis: of its own unit, else of the system's, else as the system's code says.
std::optional<double> axis_unit(const WktNode& system, std::size_t axis) {
  for (const WktNode& each : system.children) {
    if (each.keyword != "AXIS" || axis-- > 0) continue;
    if (const WktNode* unit = child_of(each, {"LENGTHUNIT", "UNIT"})) return metres_in(*unit);
  }
  if (const WktNode* unit = child_of(system, {"LENGTHUNIT", "UNIT"})) return metres_in(*unit);
  return metres_of_epsg_system(epsg_code(system));
}

std::size_t count_axes(const WktNode& system) {
  const WktNode* cs = child_of(system, {"CS"});
  if (cs != nullptr && cs->values.size() > 1) return parse_count(trim(cs->values[1])).value_or(0);
  return static_cast<std::size_t>(std::ranges::count(system.children, "AXIS", &WktNode::keyword));
}

bool is_cartesian(const WktNode& system) {
  const WktNode* cs = child_of(system, {"CS"});
  return cs != nullptr && !cs->values.empty() &&
         (cs->values[0].starts_with('C') || cs->values[0].starts_with('c'));
}

// The value of "+units=us-ft" in a text of PROJ; nothing where it has no such key.
std::string_view proj_value(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return text.substr(0, text.find_first_of(" \t\r\n"));
}

std::optional<double> proj_unit(std::string_view text, std::string_view factor,
                                std::string_view unit) {
  const std::optional<double> metres = parse_number(proj_value(text, factor));
  return metres ? metres : metres_of(proj_value(text, unit));
}

StatedUnits units_in_proj(std::string_view text) {
  const std::string_view kind = proj_value(text, "+proj=");
  if (kind == "longlat" || kind == "latlong") return {.degrees = true};
  return {.plan = proj_unit(text, "+to_meter=", "+units=").value_or(1),
          .height = proj_unit(text, "+vto_meter=", "+vunits=")};
}

// What follows "EPSG:", "epsg:" or "urn:ogc:def:crs:EPSG::" and perhaps a version of the register.
std::optional<std::string_view> code_in(std::string_view text) {
  const std::string small = lower_case(text.substr(0, text.find('[')));
  if (!small.starts_with("epsg:") && !small.starts_with("urn:ogc:def:crs:epsg:")) return {};
  return text.substr(text.rfind(':') + 1);
}

// "2225", or "26910+6360" with a system of heights.
StatedUnits units_of_code(std::string_view text) {
  const auto number = [](std::string_view digits) {
    constexpr std::size_t kMostCode = 99999;  // codes have five digits
    return static_cast<unsigned>(std::min(parse_count(trim(digits)).value_or(0), kMostCode));
  };
  const std::size_t plus = std::min(text.find('+'), text.size());
  const unsigned plan = number(text.substr(0, plus));
  StatedUnits found{.plan = metres_of_epsg_system(plan),
                    .degrees = is_epsg_system_in_degrees(plan)};
  if (plus < text.size()) found.height = metres_of_epsg_system(number(text.substr(plus + 1)));
  return found;
}

StatedUnits units_in(const WktNode& system) {
  if (is_any(system, {"COMPD_CS", "COMPOUNDCRS", "BOUNDCRS", "SOURCECRS", "COORDINATEMETADATA"})) {
    StatedUnits found;
    for (const WktNode& each : system.children) {
      const StatedUnits part = units_in(each);
      if (!found.plan) found.plan = part.plan;
      if (!found.height) found.height = part.height;
      found.degrees = found.degrees || part.degrees;
    }
    return found;
  }
  if (is_any(system, {"VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"})) {
    return {.height = axis_unit(system, 0)};
  }
  const bool geodetic = is_any(system, {"GEODCRS", "GEODETICCRS"});
  if (is_any(system, {"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"}) ||
      (geodetic && !is_cartesian(system))) {
    return {.degrees = true};
  }
  if (!geodetic && !is_any(system, {"PROJCS", "PROJCRS", "PROJECTEDCRS", "DERIVEDPROJCRS", "GEOCCS",
                                    "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"})) {
    return {};
  }
  StatedUnits found{.plan = axis_unit(system, 0)};
  if (count_axes(system) > 2) found.height = axis_unit(system, 2);
  return found;
}

}  // namespace

StatedUnits units_in_projection(std::string_view text) {
  text = trim(text.substr(0, text.find('\0')));
  if (text.find("+proj=") != std::string_view::npos) return units_in_proj(text);
  if (const auto code = code_in(text)) return units_of_code(*code);
  const std::optional<WktNode> system = parse_wkt(text);
  return system ? units_in(*system) : StatedUnits();
}

}  // namespace palpate::io
