// Unpacks LZ4 frames.
#include "bag/lz4.hpp"

#include <lz4frame.h>

#include <memory>

namespace palpate::bag {

bool unpack_lz4(View from, Bytes& to) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) {
    throw Error("there is no memory to unpack a chunk; free some");
  }
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  std::size_t out = 0;
  for (std::size_t in = 0, hint = 1; hint != 0;) {
    std::size_t written = to.size() - out;
    std::size_t read = from.size() - in;
    hint = LZ4F_decompress(made, to.data() + out, &written, from.data() + in, &read, nullptr);
    if (LZ4F_isError(hint) != 0 || (written == 0 && read == 0)) return false;
    out += written;
    in += read;
  }
  return out == to.size();
}

}  // namespace palpate::bag
