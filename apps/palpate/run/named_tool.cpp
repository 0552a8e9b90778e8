// Makes the tool that a command line names.
#include "apps/palpate/run/named_tool.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/tool/tool_proxy.hpp"

namespace palpate::app {

namespace {

constexpr double kWanted = 0.5;  // R between samples: nothing as large as R passes (Tool)
constexpr int kSpacings = 12;  // tried to find a spacing that leaves few enough samples (judgement)
// The share of samples that is left where they are farther apart: where more are, they are corners
// and creases, which no spacing takes away (judgement).
constexpr double kCorners = 0.95;
// m: the range of ToolOptions::gyration
constexpr double kLeastGyration = 1e-4;
constexpr double kMostGyration = 10;
constexpr double kInside = 1.01;  // bounds that are rounded to three digits are within

Box box_around(const std::vector<Eigen::Vector3d>& vertices) {
  Box box;
  for (const Eigen::Vector3d& vertex : vertices) box.extend(vertex);
  return box;
}

// The surface of a box, m^2.
double surface_of(const Box& box) {
  const Eigen::Vector3d size = box.size();
  return 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
}

Box box_around(const Tool& tool) {
  Box box;
  for (const Tool::Point& sample : tool.samples()) box.extend(sample.position);
  return box;
}

std::string words_of(const Eigen::Vector3d& size) {
  return fmt::format("{} x {} x {}", length(size.x()), length(size.y()), length(size.z()));
}

// Refuses a mesh that is larger than what a hand holds, or lies farther from its handle, and says
// which. `box`: m, around the vertices; `unit`: of the file, m.
void check_reach(const MeshName& name, double unit, const Box& box) {
  const double farthest = box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).maxCoeff();
  if (farthest <= Tool::kLongest) return;
  const bool large = 0.5 * box.size().maxCoeff() > Tool::kLongest;
  const bool millimetres = unit == 1 && farthest <= 1000 * Tool::kLongest;
  const std::string mesh = std::string(kMeshTool) + name.path;
  const std::string remedy =
      millimetres ? mesh + ",unit=0.001 if it is in millimetres"
                  : mesh + ",unit=METRES, the metres of a unit of the file, if it is another";
  throw Error(fmt::format(
      "--tool: {} {} if a unit of the file is {}; nobody holds what reaches more than {}: give "
      "{}{}",
      name.path,
      large ? "is " + words_of(box.size())
            : fmt::format("reaches {} from its origin, where the handle is,", length(farthest)),
      length(unit), length(Tool::kLongest), remedy,
      large ? ", or a smaller part" : ", or move it to its origin"));
}

std::vector<Ball> balls_of(const Tool& tool) {
  std::vector<Ball> balls;
  for (const Tool::Point& sample : tool.samples()) {
    balls.push_back({sample.position, sample.radius});
  }
  return balls;
}

}  // namespace

double SampledTool::gyration(double stiffness) const {
  if (!turn_stiffness) return 0;
  const double gyration = std::sqrt(*turn_stiffness / stiffness);
  if (gyration >= kLeastGyration && gyration <= kMostGyration) return gyration;
  throw UsageError(
      fmt::format("--turn-stiffness {} is out of range where the stiffness is {:.4g} N/m; give "
                  "{:.3g} to {:.3g}",
                  *turn_stiffness, stiffness, kInside * stiffness * kLeastGyration * kLeastGyration,
                  std::min(kStiffestTurn, stiffness * kMostGyration * kMostGyration / kInside)));
}

double SampledTool::turns_with(double stiffness) const {
  const ToolProxy proxy(tool, {.stiffness = stiffness, .gyration = gyration(stiffness)});
  const double used = proxy.options().gyration;
  return stiffness * used * used;
}

std::vector<Ball> SampledTool::balls() const {
  return balls_of(*tool);
}

// What else to do, where samples so near each other are not too many.
std::string SampledTool::denser() const {
  const double wanted = kWanted * radius;
  const double samples =
      static_cast<double>(tool->samples().size()) * std::pow(spacing / wanted, 2);
  if (wanted < kLeastSpacing || samples > static_cast<double>(Tool::kMostSamples) / 2) return {};
  return fmt::format(", a larger --radius, or --tool-spacing {:.3g}, which takes longer", wanted);
}

std::string SampledTool::warning() const {
  const std::size_t samples = tool->samples().size();
  if (radius > 0 && !is_of_balls() && spacing > 1.01 * kWanted * radius) {
    return fmt::format(
        "its samples are {} apart, which is more than half of R ({}): what is thinner can pass "
        "between them; give a smaller tool{}",
        length(spacing), length(radius), denser());
  }
  if (samples <= NamedTool::kMostSamples) return {};
  if (cornered) {
    return fmt::format(
        "its {} samples can take longer than a millisecond; most are at corners and creases of the "
        "mesh, of more than 20 degrees: give one with fewer, or a smoothed one",
        grouped(samples));
  }
  return fmt::format(
      "its {} samples can take longer than a millisecond; give a larger --tool-spacing, or a "
      "simpler shape",
      grouped(samples));
}

NamedTool::NamedTool(ToolPlan plan) : plan_(std::move(plan)) {
  if (mesh_file(plan_).empty()) return;
  const MeshName name = parse_mesh_tool(plan_.text);
  ReadOptions options;
  options.scale = name.unit;
  mesh_ = read_mesh(name.path, options);
  const Box box = box_around(mesh_.vertices);
  unit_ = fmt::format("{}, {}", mesh_.format, words_of(box.size()));
  check_reach(name, mesh_.unit.plan, box);
}

Tool NamedTool::with_spacing(double spacing) const {
  if (mesh_.triangles.empty()) return Tool::from_text(plan_.text, spacing);
  return Tool::mesh(mesh_.vertices, mesh_.triangles, spacing);
}

// What has too many samples is told a spacing that leaves few enough, at most twice as large as is
// needed.
Tool NamedTool::as_spaced(double spacing) const {
  try {
    return with_spacing(spacing);
  } catch (const Error&) {
    for (double wider = 2 * spacing; wider <= kLargestSpacing; wider *= 2) {
      if (!is_sampled(wider)) continue;
      throw UsageError(
          fmt::format("--tool-spacing (tool_spacing of [tool]): {} m leaves more than {} samples "
                      "of {}; give {} or more",
                      spacing, grouped(Tool::kMostSamples), plan_.text, wider));
    }
    throw;
  }
}

bool NamedTool::is_sampled(double spacing) const {
  try {
    (void)with_spacing(spacing);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// The surface of the box around it, m^2.
double NamedTool::area() const {
  return surface_of(mesh_.triangles.empty() ? box_around(with_spacing(Tool::kLongest))
                                            : box_around(mesh_.vertices));
}

std::vector<Ball> NamedTool::looked_at() const {
  constexpr double kPixels = 2.5e-3;     // m, of a depth camera of 640 pixels (judgement)
  constexpr double kMostLooks = 10'000;  // samples: 15 ms a look (judgement)
  const double spacing = std::max(kPixels, std::sqrt(area() / kMostLooks));
  return balls_of(with_spacing(std::min(spacing, plan_.spacing.value_or(spacing))));
}

SampledTool NamedTool::sampled(double radius) const {
  SampledTool result{.tool = nullptr,
                     .name = plan_.text,
                     .unit = unit_,
                     .mesh = mesh_.facts,
                     .radius = radius,
                     .turn_stiffness = plan_.turn_stiffness};
  if (plan_.spacing) {
    result.spacing = *plan_.spacing;
    result.tool = std::make_shared<const Tool>(as_spaced(result.spacing));
    return result;
  }
  constexpr auto kMost = static_cast<double>(kMostSamples);
  // A surface has a sample a square of its spacing, or twice as many.
  double spacing = std::max(kWanted * radius, std::sqrt(area() / (2 * kMost)));
  if (!(spacing > 0)) spacing = Tool::kLongest;  // a line of balls has no area
  std::size_t before = 0;
  for (int i = 0; i < kSpacings; ++i) {
    auto tool = std::make_shared<const Tool>(with_spacing(spacing));
    const auto samples = static_cast<double>(tool->samples().size());
    result.cornered =
        !mesh_.triangles.empty() && before > 0 && samples > kCorners * static_cast<double>(before);
    if (result.cornered) break;
    before = tool->samples().size();
    result.tool = std::move(tool);
    result.spacing = spacing;
    if (samples <= kMost) break;
    spacing *= std::clamp(std::sqrt(samples / kMost), 1.05, 2.0);
  }
  return result;
}

double smallest_radius(const Scene& scene) {
  double smallest = 0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::shared_ptr<const SurfacePoints> points = scene.source(i).points();
    if (!points || points->size() == 0) continue;
    smallest = smallest > 0 ? std::min(smallest, points->radius) : points->radius;
  }
  return smallest;
}

}  // namespace palpate::app
