#include "io/row.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace palpate::io {
namespace {

constexpr std::pair<std::string_view, Role> kRoleNames[] = {
    {"x", Role::x},
    {"y", Role::y},
    {"z", Role::z},
    {"nx", Role::normal_x},
    {"ny", Role::normal_y},
    {"nz", Role::normal_z},
    {"normal_x", Role::normal_x},
    {"normal_y", Role::normal_y},
    {"normal_z", Role::normal_z},
    {"normalx", Role::normal_x},
    {"normaly", Role::normal_y},
    {"normalz", Role::normal_z},
    {"red", Role::red},
    {"green", Role::green},
    {"blue", Role::blue},
    {"r", Role::red},
    {"g", Role::green},
    {"b", Role::blue},
    {"diffuse_red", Role::red},
    {"diffuse_green", Role::green},
    {"diffuse_blue", Role::blue},
    {"intensity", Role::intensity},
    {"scalar_intensity", Role::intensity},
    {"i", Role::intensity},
    {"reflectance", Role::intensity},
    {"reflectivity", Role::intensity},
    {"quality", Role::intensity},
    {"scalar", Role::intensity},
};

}  // namespace

std::optional<Role> role_of(std::string_view name) {
  std::string lower{name};
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  const auto* found = std::find_if(std::begin(kRoleNames), std::end(kRoleNames),
                                   [&](const auto& entry) { return entry.first == lower; });
  return found == std::end(kRoleNames) ? std::nullopt : std::optional{found->second};
}

Columns complete_columns(const std::array<bool, kRoleCount>& has) {
  const auto all = [&](Role a, Role b, Role c) {
    return has[index_of(a)] && has[index_of(b)] && has[index_of(c)];
  };
  return {.normals = all(Role::normal_x, Role::normal_y, Role::normal_z),
          .colors = all(Role::red, Role::green, Role::blue),
          .intensities = has[index_of(Role::intensity)]};
}

}  // namespace palpate::io
