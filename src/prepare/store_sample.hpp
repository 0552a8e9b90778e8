// Draws points of a store without reading all of it.
#pragma once

#include <cstddef>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/point_store.hpp"

namespace palpate {

/// Some points of a store, in its frame.
struct StoreSample {
  PointCloud all;     ///< thinned: those of the upper nodes
  PointCloud places;  ///< all that lie around some places
};

/// The nodes of the upper levels, the coarsest first: together they have at least `asked` points,
/// if all have.
[[nodiscard]] std::vector<std::size_t> upper_nodes(const PointStore::Layout& layout,
                                                   std::size_t asked);

/// Takes at least `asked` points of all of the store, and the `around` nearest ones at each of so
/// many `places`, which are spread over its points. Always the same of the same store.
/// @throws Error as PointStore::read() does, and when no point is left.
[[nodiscard]] StoreSample sample_of(const PointStore& store, std::size_t asked, std::size_t places,
                                    std::size_t around);

}  // namespace palpate
