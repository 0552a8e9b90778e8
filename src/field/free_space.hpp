#pragma once

#include <span>

#include "field/evaluate.hpp"
#include "field/patch.hpp"

namespace palpate {

/// Does a ball that no patch covers certainly hold nothing? Walks through the index itself and
/// gives up, with `false`, as soon as the weights could make a surface or when `visits`, of which
/// every cell and point takes one, have run out. The same bound as is_free() for a patch
/// (algorithm.md section 2.2). `radius`: of all points, m; 0: each has its own.
[[nodiscard]] bool is_free_space(const ImplicitSurface& surface,
                                 std::span<const ActiveLayer> layers, int sources, const Ball& ball,
                                 double radius, int& visits) noexcept;

}  // namespace palpate
