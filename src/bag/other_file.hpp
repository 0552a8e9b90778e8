#pragma once

#include "bag/mcap_format.hpp"
#include "bag/random_file.hpp"

namespace palpate::bag {

/// Reports what a file is that does not begin as MCAP files do, and how it becomes one.
/// @throws Error always.
[[noreturn]] void refuse_other(const RandomFile& file);

}  // namespace palpate::bag
