#pragma once

#include "io/input.hpp"

namespace palpate::io {

/// Throws Error for archives and documents that hold scans or scenes in ways that are not read:
/// what it is, and how to get what is. Returns for all else.
void refuse_containers(const Input& input);

}  // namespace palpate::io
