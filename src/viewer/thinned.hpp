#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::viewer {

/// At most `budget` of `count` points, rising: one of each of `budget` equal stretches of their
/// order. Along a CellGrid's Morton order, stretches are places: what is left covers all as the
/// points did, and the same points stay from one call to the next.
[[nodiscard]] std::vector<std::uint32_t> thinned(std::size_t count, std::size_t budget);

/// How many points each of several clouds may show so that all show no more than `budget`: in
/// proportion to their sizes.
[[nodiscard]] std::vector<std::size_t> shares(const std::vector<std::size_t>& sizes,
                                              std::size_t budget);

}  // namespace palpate::viewer
