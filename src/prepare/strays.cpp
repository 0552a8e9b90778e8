#include "prepare/strays.hpp"

#include "geometry/parallel.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
namespace {

// A point this many typical spacings from its neighbours has to be on a sheet with them.
constexpr double kStraySpacings = 4;
constexpr double kStrayWindow = 3;          // of its own spacings
constexpr std::size_t kManyInWindow = 120;  // points; 28 on a sheet
constexpr double kOffDenser = 0.3;          // typical spacings

bool is_stray(const SheetInput& input, std::size_t i, double typical, SheetFitter& fitter) {
  const auto own = static_cast<double>(input.spacings[i]);
  if (own <= kStraySpacings * typical) return false;
  const double radius = kStrayWindow * own;
  const SheetFit fit = fitter.fit(input.grid, input.grid.points()[i], radius, own);
  if (!fit.is_sheet(radius, input.noise)) return true;
  if (fitter.places(own) < SheetFitter::kEnough) return true;
  // Where others lie far denser it has to be on what they tell, as they do.
  const double most = kOffDenser * typical + 3 * input.noise;
  return fit.points > kManyInWindow && fit.off > most;
}

}  // namespace

std::vector<std::uint8_t> find_strays(const SheetInput& input, double typical) {
  std::vector<std::uint8_t> strays(input.grid.size());
  detail::parallel_ranges(strays.size(), 4096, [&](std::size_t begin, std::size_t end) {
    SheetFitter fitter;
    for (std::size_t i = begin; i < end; ++i) {
      strays[i] = is_stray(input, i, typical, fitter) ? 1 : 0;
    }
  });
  return strays;
}

}  // namespace palpate
