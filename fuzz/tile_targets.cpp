// Checks what is read of a LAS file piece by piece.
#include <stdexcept>

#include "extras/tile/input.hpp"
#include "memory_file.hpp"
#include "palpate/base/error.hpp"
#include "targets.hpp"

namespace palpate::fuzz {

void check_pieces(std::span<const std::byte> bytes) {
  const MemoryFile file(bytes);
  try {
    const io::tile::TileInput input = io::tile::open_las(file.path(), {});
    std::size_t points = 0;
    for (std::size_t i = 0; i < input.pieces; ++i) points += input.read(i).size();
    if (points > input.points) throw std::logic_error("pieces that are more than all");
  } catch (const Error&) {
    return;
  }
}

}  // namespace palpate::fuzz
