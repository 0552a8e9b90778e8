#include "io/row.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace palpate::io {
namespace {

constexpr std::pair<std::string_view, Role> kNames[] = {
    {"x", Role::kX},
    {"y", Role::kY},
    {"z", Role::kZ},
    {"nx", Role::kNormalX},
    {"ny", Role::kNormalY},
    {"nz", Role::kNormalZ},
    {"normal_x", Role::kNormalX},
    {"normal_y", Role::kNormalY},
    {"normal_z", Role::kNormalZ},
    {"normalx", Role::kNormalX},
    {"normaly", Role::kNormalY},
    {"normalz", Role::kNormalZ},
    {"red", Role::kRed},
    {"green", Role::kGreen},
    {"blue", Role::kBlue},
    {"r", Role::kRed},
    {"g", Role::kGreen},
    {"b", Role::kBlue},
    {"diffuse_red", Role::kRed},
    {"diffuse_green", Role::kGreen},
    {"diffuse_blue", Role::kBlue},
    {"intensity", Role::kIntensity},
    {"scalar_intensity", Role::kIntensity},
    {"i", Role::kIntensity},
    {"reflectance", Role::kIntensity},
    {"reflectivity", Role::kIntensity},
    {"quality", Role::kIntensity},
    {"scalar", Role::kIntensity},
};

}  // namespace

std::optional<Role> role_of(std::string_view name) {
  std::string lower{name};
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  const auto* found = std::find_if(std::begin(kNames), std::end(kNames),
                                   [&](const auto& entry) { return entry.first == lower; });
  return found == std::end(kNames) ? std::nullopt : std::optional{found->second};
}

Columns complete_columns(const std::array<bool, kRoleCount>& has) {
  const auto all = [&](Role a, Role b, Role c) {
    return has[index_of(a)] && has[index_of(b)] && has[index_of(c)];
  };
  return {.normals = all(Role::kNormalX, Role::kNormalY, Role::kNormalZ),
          .colors = all(Role::kRed, Role::kGreen, Role::kBlue),
          .intensities = has[index_of(Role::kIntensity)]};
}

}  // namespace palpate::io
