// Makes pages of an E57 file with right CRCs, so that tests reach what lies behind them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/e57/pages.hpp"

namespace palpate::fuzz {

/// `data` cut into pages; zeros fill the last one.
inline std::vector<std::byte> e57_pages_of(std::span<const std::byte> data) {
  std::vector<std::byte> file;
  while (!data.empty()) {
    const std::size_t count = std::min<std::size_t>(data.size(), io::kE57PageData);
    std::vector<std::byte> page(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(count));
    page.resize(io::kE57PageData);
    const std::uint32_t crc = io::e57_crc(page.data());
    for (unsigned shift = 32; shift > 0; shift -= 8) {  // big endian
      page.push_back(static_cast<std::byte>(crc >> (shift - 8)));
    }
    file.insert(file.end(), page.begin(), page.end());
    data = data.subspan(count);
  }
  return file;
}

}  // namespace palpate::fuzz
