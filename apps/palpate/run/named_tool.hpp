// The tool that a command line names.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/options/tool_options.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate::app {

/// A tool with samples as dense as what it touches requires.
struct SampledTool {
  std::shared_ptr<const Tool> tool;
  std::string name;       ///< as it was named
  std::string unit = {};  ///< of a mesh, in words; empty: as it was named
  MeshFacts mesh = {};    ///< of its faces
  double spacing = 0;     ///< between samples, at most, m
  double radius = 0;      ///< R of what it touches, m; 0: unknown
  bool cornered = false;  ///< no spacing leaves few enough: they are corners and creases
  std::optional<double> turn_stiffness = {};  ///< N m/rad in the world; unset: fits the tool

  /// ToolOptions::gyration with a surface of `stiffness` N/m, m.
  /// @throws UsageError when turns that stiff have none.
  [[nodiscard]] double gyration(double stiffness) const;

  /// The stiffness of its turns with a surface of `stiffness` N/m, N m/rad. @throws UsageError as
  /// gyration() does.
  [[nodiscard]] double turns_with(double stiffness) const;

  /// Is it a ball or a row of them, which no spacing changes?
  [[nodiscard]] bool is_of_balls() const { return tool->samples().front().radius > 0; }

  /// The samples as balls around its handle, m.
  [[nodiscard]] std::vector<Ball> balls() const;

  /// Why something may pass between its samples, or a step take long, and what to do; empty: all
  /// is well.
  [[nodiscard]] std::string warning() const;
  /// The part of it that names a --tool-spacing; empty where none is in range.
  [[nodiscard]] std::string denser() const;
};

/// A tool whose surface is known, and not where it is sampled.
class NamedTool {
 public:
  /// Reads the file of a mesh. `plan` names a tool.
  /// @throws Error when that cannot be read, or is no tool's.
  explicit NamedTool(ToolPlan plan);

  /// Samples half of `radius` apart (m, R of what it touches; 0: it is not known yet), or as far as
  /// kMostSamples allow, unless the plan says how far.
  /// @throws Error as Tool does, UsageError where the plan's spacing leaves too many samples.
  [[nodiscard]] SampledTool sampled(double radius) const;

  /// Its surface around the handle, m, so dense that cameras miss nothing that is wider than two of
  /// their pixels at half a metre; of large tools less. @throws Error as Tool does.
  [[nodiscard]] std::vector<Ball> looked_at() const;

  /// Samples that a step of 1 ms bears (ToolProxy::max_evaluations()).
  static constexpr std::size_t kMostSamples = 500;

 private:
  [[nodiscard]] Tool with_spacing(double spacing) const;
  [[nodiscard]] bool is_sampled(double spacing) const;
  [[nodiscard]] Tool as_spaced(double spacing) const;
  [[nodiscard]] double area() const;

  ToolPlan plan_;
  TriangleMesh mesh_;
  std::string unit_;
};

/// The smallest R of the sources' surfaces, m; 0: there is none yet.
[[nodiscard]] double smallest_radius(const Scene& scene);

}  // namespace palpate::app
