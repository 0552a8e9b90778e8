// Declares the files into which points are sorted by chunks.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/tile/plan.hpp"

namespace palpate::io::tile {

/// The file of a chunk's points in a folder.
[[nodiscard]] std::filesystem::path chunk_file(const std::filesystem::path& folder,
                                               std::size_t chunk);

/// Reads all points and appends each to its chunk's file. Removes what is in the folder before.
void distribute(const Inputs& inputs, const Plan& plan, const std::filesystem::path& folder,
                const Told& told);

}  // namespace palpate::io::tile
