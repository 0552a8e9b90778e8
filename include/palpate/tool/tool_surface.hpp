// The interface between a surface and the proxy of a tool that turns.
#pragma once

#include <limits>

#include "palpate/field/field.hpp"
#include "palpate/geometry/pose.hpp"
#include "palpate/tool/tool.hpp"

namespace palpate {

/// A surface as a whole tool meets it. Samples of the tool are in groups, and each group has a
/// field of its own: what is near it, from the side from which it came. Fields of a group are as
/// Field requires, and their end_step() is called where the group touches or is nearest. The
/// defaults are those of a field that serves all samples alike. Belongs to one thread.
class ToolSurface {
 public:
  static constexpr int kMostGroups = 64;  ///< 26 MB of patches (judgement)

  virtual ~ToolSurface() = default;

  /// The surface for what is no sample. Its traits hold for all groups, and its begin_step() and
  /// end_step() enclose a step of the tool.
  [[nodiscard]] virtual const Field& whole() const noexcept = 0;

  /// The group of a sample, by its index in Tool::samples(): 0 to kMostGroups - 1. It stays the
  /// same while a step lasts.
  [[nodiscard]] virtual int group_of(int /*sample*/) const noexcept { return 0; }
  /// The surface near a group.
  [[nodiscard]] virtual const Field& group(int /*number*/) const noexcept { return whole(); }
  /// How far all fields are pushed out of what is touched, m: no more than any sample has of a
  /// radius, and what a sample has beyond that is its own.
  [[nodiscard]] virtual double pushed_out() const noexcept { return 0; }
  /// The tool is held like this when samples are looked at next.
  virtual void place(const Pose& /*tool*/) const noexcept {}
  /// The tool was put where it is: on which side of a surface it was before says nothing.
  virtual void forget_sides() const noexcept {}

  /// Is a sample of the tool, as it was placed last, deeper (m) than this behind a surface that its
  /// finger is in front of?
  [[nodiscard]] virtual bool is_across(double /*deeper*/) const noexcept { return false; }

  /// How far the surface has moved since the last step began at most, m, where its revision is
  /// another than then; infinite where it may be another surface.
  [[nodiscard]] virtual double moved() const noexcept {
    return std::numeric_limits<double>::infinity();
  }

  /// Does it know the samples of this tool?
  [[nodiscard]] virtual bool serves(const Tool& /*tool*/) const noexcept { return true; }

 protected:
  ToolSurface() = default;
  ToolSurface(const ToolSurface&) = default;
  ToolSurface& operator=(const ToolSurface&) = default;
};

}  // namespace palpate
