// The seeds of the fuzz targets, and what broke a reader once, as they are and cut at every byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "targets.hpp"

namespace palpate::fuzz {
namespace {

std::vector<std::filesystem::path> seeds(std::string_view target) {
  std::vector<std::filesystem::path> paths;
  const auto folder = std::filesystem::path(PALPATE_CORPUS) / target;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Corpus : public testing::TestWithParam<std::string_view> {};

TEST_P(Corpus, EverySeedAndEveryCutOfItIsReadOrRefused) {
  const auto paths = seeds(GetParam());
  ASSERT_FALSE(paths.empty()) << "no seeds under " << PALPATE_CORPUS;
  for (const auto& path : paths) {
    const std::string bytes = bytes_of(path);
    for (std::size_t size = 0; size <= bytes.size(); ++size) {
      EXPECT_NO_THROW(run_target(GetParam(), std::as_bytes(std::span(bytes.data(), size))))
          << path << " cut to " << size;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Io, Corpus, testing::ValuesIn(target_names()),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace palpate::fuzz
