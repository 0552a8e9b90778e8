#pragma once

#include "bag/mcap_format.hpp"

namespace palpate::bag {

/// Unpacks an LZ4 frame into all of `to`. False: it is damaged, or of another size.
/// @throws Error where there is no memory, or no LZ4 in this build.
[[nodiscard]] bool unpack_lz4(View from, Bytes& to);

}  // namespace palpate::bag
