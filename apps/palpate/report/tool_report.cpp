// Reports on a tool that turns.
#include "apps/palpate/report/tool_report.hpp"

namespace palpate::app {

void add_tool(Report& report, const SampledTool& tool, double stiffness) {
  const bool balls = tool.is_of_balls();
  report.row("tool",
             "{tool/shape}[ ({tool/file})]: {tool/samples} [{?}balls|samples]"
             "[{?}, {tool/spacing_m} apart][{?}; R of what it touches is {tool/radius_m}]",
             tool.name, tool.unit, tool.tool->samples().size(), balls, !balls, tool.spacing,
             tool.radius > 0, tool.radius);
  if (!tool.unit.empty()) {
    report.row("",
               "[{tool/faces_dropped} faces of the mesh left out, which have no area or are not "
               "finite]",
               tool.mesh.dropped);
    report.row("", "[{tool/faces_duplicate} faces of the mesh left out, which are there twice]",
               tool.mesh.duplicates);
  }
  report.row("", "{tool/extent_m} long from its handle on, radius of gyration {tool/gyration_m}",
             tool.tool->extent(), tool.tool->gyration());
  report.row("", "turns with {tool/turn_stiffness_Nm_per_rad} where it shifts with {_N_per_m}",
             tool.turns_with(stiffness), stiffness);
  report.row({"", Mark::warning}, "[{tool/warning}]", tool.warning());
}

}  // namespace palpate::app
