// Declares how the files of chunks become a store's own files.
#pragma once

#include <filesystem>
#include <string>

#include "io/tile/out_file.hpp"
#include "io/tile/state.hpp"
#include "io/tile/tree.hpp"

namespace palpate::io::tile {

/// Sorts the chunks, two side by side, and joins them. Goes on where `state` says.
class StoreBuilder {
 public:
  /// `work`: the folder with the chunks, in which the store grows. What is in its files beyond what
  /// `state` says is cut off.
  StoreBuilder(State& state, const std::filesystem::path& work);

  /// Saves the state after each chunk.
  void sort_chunks(const Told& told);

  /// Adds the levels above the chunks, and writes what describes the store.
  void finish(const std::string& name);

 private:
  struct Grown;
  [[nodiscard]] Grown grow(std::size_t i) const;
  void take(Grown& grown);
  void append(Settled& settled);
  [[nodiscard]] std::vector<StoreNode> listed_nodes() const;
  class Top;

  State& state_;
  const Plan& plan_;
  std::filesystem::path work_;
  OutFile octree_;
  OutFile nodes_;
  OutFile roots_;
};

}  // namespace palpate::io::tile
