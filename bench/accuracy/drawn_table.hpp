#pragma once

#include <string>
#include <vector>

#include "accuracy/table.hpp"

namespace palpate::accuracy {

/// Targets of a row of drawn layouts under a noise, for depth frames.
struct DrawnLimits {
  Limit normal;  ///< degrees
  Limit force;   ///< N
  Limit lost;    ///< %
};

[[nodiscard]] DrawnLimits drawn_limits(NoiseKind noise, const std::string& row);

/// Share of a contender's frames in which a metric of a row is above a value, %.
[[nodiscard]] double share_above(const BenchResults& results, const std::string& contender,
                                 const Target& target, double value);

/// Normal / force / lost over all frames of every row but those at the cloud's edge, as Markdown:
/// targets, and for each contender the median with the worst frame in brackets and the share of
/// frames above the target (for the median, where there is one for the worst frame, too).
[[nodiscard]] std::string markdown_drawn(const BenchResults& results,
                                         const std::vector<Contender>& contenders, NoiseKind noise);

}  // namespace palpate::accuracy
