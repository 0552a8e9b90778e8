// Declares the writer of Potree 2.0 stores, for clouds that are too large for memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "palpate/geometry/shapes.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io::tile {

struct TileOptions {
  ReadOptions reading = {};              ///< of which the scale is used
  bool force = false;                    ///< replace what is there, whole or not
  std::size_t chunk_points = 8'000'000;  ///< sorted at once (judgement: 0.5 GB for each)
  std::size_t leaf_points = 16'384;      ///< a page of Potree takes so many at once (judgement)
  /// Called with what is done and 0 ... 1 now and then, on any thread but never twice at once; may
  /// throw to give up: the next call goes on from there.
  std::function<void(const std::string& step, double done)> progress{};
  /// Returns the free bytes of a folder's disk; empty: the system does.
  std::function<std::uint64_t(const std::filesystem::path& folder)> free_bytes{};
};

struct TileResult {
  struct Input {
    std::string name;
    std::string format;
    FileUnit unit;  ///< that was used
    Box box;        ///< m, of its points as announced
  };
  std::vector<Input> inputs = {};  ///< files
  std::size_t points = 0;
  std::size_t dropped = 0;  ///< marked as not to be used, or not finite
  std::uint64_t bytes = 0;  ///< of octree.bin
  double step = 0;          ///< m, of coordinates
  double spacing = 0;       ///< m, of the root's points
};

/// Writes the points of all inputs to `out` as a Potree 2.0 store of encoding DEFAULT; method: M.
/// Schuetz, S. Ohrhallinger, M. Wimmer, "Fast Out-of-Core Octree Generation", 2020. The bytes
/// depend on the inputs and options alone.
///
/// Until it is whole the store grows in `out`/unfinished. A call that was ended there, for whatever
/// reason, is gone on with by the next one. Uses 2 GB of memory at most, unless an input can only
/// be read whole.
/// @param inputs files, or "synthetic:terrain:N".
/// @throws Error that states what is wrong with an input or with `out`: it is complete already, was
///   begun with other inputs or options, or its disk has too little space.
TileResult tile(const std::vector<std::string>& inputs, const std::filesystem::path& out,
                const TileOptions& options = {});

}  // namespace palpate::io::tile
