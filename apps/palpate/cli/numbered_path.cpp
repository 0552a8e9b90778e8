#include "apps/palpate/cli/numbered_path.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace palpate::app {

std::string numbered_path(const std::string& path, std::size_t hand) {
  if (hand == 0 || path.empty()) return path;
  const std::filesystem::path plain(path);
  const std::string name =
      fmt::format("{}-{}{}", plain.stem().string(), hand + 1, plain.extension().string());
  return (plain.parent_path() / name).string();
}

}  // namespace palpate::app
