#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace palpate::sensor {

/// The depth images of a folder or, where there are none, its clouds, in the order of the numbers
/// in their names. `wanted`: a folder in it; empty: its folder "depth", or else itself.
/// @throws Error when it cannot be listed.
[[nodiscard]] std::vector<std::filesystem::path> frames_in(const std::filesystem::path& folder,
                                                           const std::string& wanted);

}  // namespace palpate::sensor
