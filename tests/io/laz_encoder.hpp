// Declares the LAZ encoder of the tests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

struct LazWriting {
  std::uint32_t chunk = 50000;  ///< points
  bool varying = false;         ///< chunks of different sizes, `chunk` at most
  std::string record{};         ///< a record of the header, its own header included
  bool place_at_end = false;    ///< the place of the chunk table is at the end of the file
};

/// Compresses a LAS file of formats 0 - 3 or 6 - 8, whatever its extra bytes.
[[nodiscard]] std::string laz_of(std::string_view las, const LazWriting& writing = {});

}  // namespace palpate
