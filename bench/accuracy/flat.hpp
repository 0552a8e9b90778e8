#pragma once

#include <string>
#include <vector>

#include "accuracy/table.hpp"

namespace palpate::accuracy {

/// Slides of 3 mm depth, 10 cm long, on a plane alone, in bins of 0.5 to 1.2 m along the optical
/// axis and of 0 to 60 degrees between normal and line of sight: what noise of long waves, and
/// terraces (BenchOptions::terraces), make of flat things. A frame of a bin draws its distance,
/// incidence, place in the image and direction from its seed; there are as many as options.seeds.
[[nodiscard]] BenchResults run_flat(const BenchOptions& options,
                                    const std::vector<Contender>& contenders);

/// Normal (degrees) / height (mm) / largest step of force (N) by bin, median (worst), as Markdown.
[[nodiscard]] std::string markdown_flat(const BenchResults& results, const std::string& contender);

}  // namespace palpate::accuracy
