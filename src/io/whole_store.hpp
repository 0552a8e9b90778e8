// Declares what reads all of a point store into memory.
#pragma once

#include "io/input.hpp"
#include "palpate/geometry/point_store.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

/// All nodes in their order as one cloud, which has the columns that all nodes with points have.
/// Reads on all cores. `input` gives the store's name and the options; it needs no bytes.
/// @throws Error where the store is damaged, or needs more memory than is free.
[[nodiscard]] CloudFile read_whole(const PointStore& store, const Input& input);

}  // namespace palpate::io
