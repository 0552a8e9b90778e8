// Options of what the hands hold.
#include "apps/palpate/options/tool_options.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate::app {

namespace {

constexpr double kLargestUnit = 1000;  // m, of a file's lengths: kilometres

constexpr const char* kToolHelp =
    "what the hands hold instead of a point, in mm: ball:R, capsule:LxR, cylinder:LxR, box:XxYxZ, "
    "gripper:XxYxZ (a finger's size), or mesh:FILE[,unit=METRES] (PLY, OBJ, STL, glTF, GLB; the "
    "handle is at its origin). It turns as the device's handle does; devices feel its force, and "
    "its torque and grip where they render them";

// A shape is checked at once, a file when the run begins.
std::string checked_tool(const std::string& text) {
  if (text.starts_with(kMeshTool)) {
    (void)parse_mesh_tool(text);
    return text;
  }
  try {
    (void)Tool::from_text(text, Tool::kLongest);
  } catch (const Error& error) {
    const bool known = text.find(':') != std::string::npos &&
                       std::string_view(error.what()).find("is no shape") == std::string_view::npos;
    throw UsageError(
        fmt::format("--tool: {}{}", error.what(), known ? "" : ", or mesh:FILE for a part"));
  }
  return text;
}

}  // namespace

MeshName parse_mesh_tool(const std::string& text) {
  constexpr std::string_view kUnit = ",unit=";
  MeshName name{text.substr(kMeshTool.size())};
  if (const std::size_t at = name.path.rfind(kUnit); at != std::string::npos) {
    const std::string unit = name.path.substr(at + kUnit.size());
    const char* const form = "the metres of a unit of the file, e.g. 0.001 for millimetres";
    name.unit = parse_numbers(unit, 1, "--tool: unit", form).front();
    if (!(*name.unit > 0 && *name.unit <= kLargestUnit)) {
      throw UsageError(fmt::format("--tool: unit={} is out of range; give {}", unit, form));
    }
    name.path.erase(at);
  }
  if (name.path == "-") {
    throw UsageError(
        "--tool: a mesh is not read from standard input; name its file: mesh:part.stl");
  }
  if (name.path.empty()) {
    throw UsageError("--tool: mesh: names no file; give one behind the colon: mesh:part.stl");
  }
  return name;
}

std::string mesh_file(const ToolPlan& tool) {
  return tool.text.starts_with(kMeshTool) ? parse_mesh_tool(tool.text).path : "";
}

void add_tool_shape(OptionTable& table, ToolPlan& tool) {
  table.add_text(
      "--tool", KeyKind::mesh_or_text, "SHAPE",
      [&tool](const std::string& text) { tool.text = checked_tool(text); }, kToolHelp);
  table
      .add("--tool-spacing", tool.spacing, "METRES",
           number("between 1e-6 and 1 m",
                  [](double x) { return x >= kLeastSpacing && x <= kLargestSpacing; }),
           "how far the samples of a --tool's surface are apart (default: half of the support "
           "radius R of what is touched, more where that would be over 500 samples)")
      .only_for(kTurns);
}

void add_tool_options(OptionTable& table, ToolPlan& tool) {
  add_tool_shape(table, tool);
  table
      .add(
          "--turn-stiffness", tool.turn_stiffness, "NM/RAD",
          number("above 0 and at most 10000", [](double x) { return x > 0 && x <= kStiffestTurn; }),
          "stiffness of a --tool's turns about its handle (default: the stiffness times the "
          "square of the tool's radius of gyration)")
      .only_for(kTurns);
}

}  // namespace palpate::app
