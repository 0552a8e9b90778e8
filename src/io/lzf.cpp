#include "io/lzf.hpp"

#include <algorithm>

namespace palpate::io {

std::optional<std::size_t> lzf_unpack(std::span<const std::byte> packed,
                                      std::span<std::byte> unpacked) {
  std::size_t in = 0;
  std::size_t out = 0;
  while (in < packed.size()) {
    const std::size_t begin = in;
    const auto control = std::to_integer<std::size_t>(packed[in++]);
    if (control < 32) {
      const std::size_t run = control + 1;
      if (packed.size() - in < run || unpacked.size() - out < run) return begin;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), run,
                  unpacked.begin() + static_cast<std::ptrdiff_t>(out));
      in += run;
      out += run;
      continue;
    }
    std::size_t length = (control >> 5U) + 2;
    const std::size_t more = length == 9 ? 2 : 1;
    if (packed.size() - in < more) return begin;
    if (more == 2) length += std::to_integer<std::size_t>(packed[in++]);
    const std::size_t back =
        ((control & 31U) << 8U) + std::to_integer<std::size_t>(packed[in++]) + 1;
    if (back > out || unpacked.size() - out < length) return begin;
    // Byte by byte: the copy may overlap what it writes, and repeats it then.
    for (std::size_t i = 0; i < length; ++i, ++out) unpacked[out] = unpacked[out - back];
  }
  return out == unpacked.size() ? std::nullopt : std::optional{in};
}

}  // namespace palpate::io
