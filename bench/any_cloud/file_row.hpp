#pragma once

#include <filesystem>

#include "any_cloud/hostile_scene.hpp"

namespace palpate::any_cloud {

/// A cloud whose truth nobody knows: `ways` straight ways through air that is free for certain
/// (farther from the nearest point than three of its spacings and than 20 mm), and presses on it.
/// @throws Error as read_cloud() does.
[[nodiscard]] Row file_row(const std::filesystem::path& path, int ways);

}  // namespace palpate::any_cloud
