// Options of what the hands hold.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace palpate::app {

// N m/rad: no device's; a table's leg does not give way to a hand's turn by more (judgement)
inline constexpr double kStiffestTurn = 1e4;
// m, of --tool-spacing (judgement)
inline constexpr double kLeastSpacing = 1e-6;
inline constexpr double kLargestSpacing = 1;

class OptionTable;

// Begins the name of a tool that is a file.
inline constexpr std::string_view kMeshTool = "mesh:";

/// What all hands hold in the place of a point.
struct ToolPlan {
  std::string text = {};                      ///< "box:40x60x20"; empty: a point
  std::optional<double> turn_stiffness = {};  ///< N m/rad in the world; unset: fits the tool
  std::optional<double> spacing = {};         ///< m, between samples; unset: fits the surface

  [[nodiscard]] bool turns() const { return !text.empty(); }
};

/// The file of a tool "mesh:FILE[,unit=METRES]".
struct MeshName {
  std::string path;
  std::optional<double> unit = {};  ///< m; unset: nobody states it
};

/// @throws UsageError where there is no file, or its unit is none.
[[nodiscard]] MeshName parse_mesh_tool(const std::string& text);

/// The file that a tool is read from; empty: none.
[[nodiscard]] std::string mesh_file(const ToolPlan& tool);

/// Registers `--tool` and how its turns feel.
void add_tool_options(OptionTable& table, ToolPlan& tool);

/// The same with its spacing alone: of what is described, not felt.
void add_tool_shape(OptionTable& table, ToolPlan& tool);

}  // namespace palpate::app
