// Declares how far a store has come: what tile.json says.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/tile/plan.hpp"

namespace palpate::io::tile {

/// A file that is tiled, as it was when that began.
struct NamedInput {
  std::string name;
  std::uint64_t bytes = 0;
  std::int64_t changed = 0;  ///< ns since an epoch of the system's

  bool operator==(const NamedInput&) const = default;
};

/// What makes the bytes of a store what they are.
struct Job {
  std::vector<NamedInput> inputs;
  double scale = 1;
  std::size_t chunk_points = 0;
  std::size_t leaf_points = 0;

  bool operator==(const Job&) const = default;
};

struct State {
  Job job;
  Plan plan;
  bool distributed = false;  ///< all points are in the files of their chunks
  std::size_t chunks = 0;    ///< those that are sorted
  std::uint64_t octree = 0;  ///< bytes of these in octree.bin, in the lists of nodes and of roots
  std::uint64_t nodes = 0;
  std::uint64_t roots = 0;
  bool finished = false;  ///< the store is whole; its files may be in place already
};

void save(const State& state, const std::filesystem::path& path);

/// Nothing where there is no such file. @throws Error where it is damaged.
[[nodiscard]] std::optional<State> load_state(const std::filesystem::path& path);

}  // namespace palpate::io::tile
