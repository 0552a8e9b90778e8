// Declares how the files of chunks become a store's own files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "extras/tile/out_file.hpp"
#include "extras/tile/plan.hpp"
#include "extras/tile/tree.hpp"

namespace palpate::io::tile {

/// Makes a store of sorted chunks. Of each one that is done a file records what came of it, so
/// another builder in the same folder goes on behind them.
class StoreBuilder {
 public:
  /// `work`: the folder in which the store grows; the chunks are in `work`/points.
  /// @param most points of a leaf.
  StoreBuilder(const Plan& plan, std::size_t most, const std::filesystem::path& work);

  /// Sorts the chunks, two side by side.
  void sort_chunks(const Report& report);

  /// Adds the levels above the chunks, and writes what describes the store, metadata.json last.
  void finish(const std::string& name);

 private:
  struct Grown {
    Settled settled;
    Branch root;  // it may still lose points to the levels above
  };
  [[nodiscard]] std::filesystem::path file(std::size_t chunk) const;
  [[nodiscard]] Grown grow(std::size_t chunk) const;
  void take(std::size_t chunk, Grown& grown);
  void append(Settled& settled);
  [[nodiscard]] Branch read(std::size_t chunk);
  [[nodiscard]] Branch branch_at(const Cell& cell, std::size_t& chunk);

  const Plan& plan_;
  Tree tree_;
  std::filesystem::path work_;
  std::size_t done_;  // chunks
  OutFile octree_;
  std::vector<StoreNode> nodes_;  // that are settled, once the chunks are
};

}  // namespace palpate::io::tile
