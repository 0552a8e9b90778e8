// The table of refinements: a name, when it runs, what it does.
#include "refine/refinements.hpp"

#include <array>

#include "refine/gaps.hpp"
#include "refine/outliers.hpp"
#include "refine/second_planes.hpp"
#include "refine/segments.hpp"

namespace palpate {
namespace {

// Derived: each runs once what it reads is there.
constexpr std::array kRefinements{
    Refinement{"outliers", Stage::radii, &refine_outliers},
    Refinement{"gaps", Stage::fits, &refine_gaps},
    Refinement{"segments", Stage::weights, &refine_segments},
    Refinement{"outliers_off_segments", Stage::weights, &refine_outliers_off_segments},
    Refinement{"second_planes", Stage::points, &refine_second_planes},
};

}  // namespace

std::span<const Refinement> refinements() {
  return kRefinements;
}

}  // namespace palpate
