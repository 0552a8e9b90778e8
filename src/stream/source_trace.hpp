#pragma once

#include <cstdint>
#include <span>

#include "palpate/scene/source.hpp"
#include "scene/tool_reach.hpp"

namespace palpate {

/// Gives recordings what a source's surfaces depended on besides frames and options, and lets
/// replays impose it. The source, in a scene, outlives it. On the thread that pushes.
class SourceTrace {
 public:
  explicit SourceTrace(Source& source) : source_(&source) {}

  /// Where tools can be by the fields' reports, as the last push read them.
  [[nodiscard]] std::span<const Reach> reach() const;

  /// Snapshots that push(), set() and keep() have published so far.
  [[nodiscard]] std::uint64_t publications() const;

  /// Options of change() that pushes have taken so far.
  [[nodiscard]] std::uint64_t changes() const;

  /// The options of the last push.
  [[nodiscard]] const SourceOptions& options() const;

  /// The next push reads these, at most ReachTable::kSlots, and nothing of fields.
  void impose_reach(std::span<const Reach> reach);

  /// Fields widen all supports of this source to this radius, m, until sources are compared again.
  void impose_least_radius(double radius);

 private:
  Source* source_;
};

}  // namespace palpate
