// Reads the pages of E57 files and checks their CRCs.
#include "io/e57/pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// CRC-32C (Castagnoli, reflected) of each byte, and of each byte with 1, 2 and 3 zeros behind it.
constexpr auto kCrcs = [] {
  constexpr std::uint32_t kPolynomial = 0x82F63B78;  // format
  std::array<std::array<std::uint32_t, 256>, 4> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U) * kPolynomial;
    table[0][byte] = crc;
  }
  for (std::size_t zeros = 1; zeros < 4; ++zeros) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = table[zeros - 1][byte];
      table[zeros][byte] = crc >> 8U ^ table[0][crc & 255U];
    }
  }
  return table;
}();

}  // namespace

// Four bytes a step.
std::uint32_t e57_crc(const std::byte* data) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (std::uint64_t i = 0; i < kE57PageData; i += 4) {
    crc ^= load_as<std::uint32_t>(data + i);
    crc = kCrcs[3][crc & 255U] ^ kCrcs[2][crc >> 8U & 255U] ^ kCrcs[1][crc >> 16U & 255U] ^
          kCrcs[0][crc >> 24U];
  }
  return ~crc;
}

std::uint64_t E57Pages::size() const {
  return input_.bytes.size() / kE57Page * kE57PageData;
}

std::uint64_t E57Pages::logical_of(std::uint64_t physical) {
  return physical / kE57Page * kE57PageData + physical % kE57Page;
}

std::uint64_t E57Pages::byte_of(std::uint64_t logical) {
  return logical / kE57PageData * kE57Page + logical % kE57PageData;
}

void E57Pages::read(std::uint64_t logical, std::uint64_t size, std::vector<std::byte>& into,
                    std::string_view what) {
  if (logical > this->size() || size > this->size() - logical) {
    fail_at_byte(input_, input_.bytes.size(), fmt::format("the file ends before {} does", what),
                 "Download or copy it again");
  }
  into.resize(size);
  for (std::uint64_t done = 0; done < size;) {
    const std::uint64_t page = (logical + done) / kE57PageData;
    const std::uint64_t left_in_page = kE57PageData - (logical + done) % kE57PageData;
    const std::uint64_t count = std::min(size - done, left_in_page);
    if (page != checked_) check(page);
    std::memcpy(into.data() + done, input_.bytes.data() + byte_of(logical + done), count);
    done += count;
  }
}

void E57Pages::check(std::uint64_t page) {
  const std::byte* data = input_.bytes.data() + page * kE57Page;
  if (load_as<std::uint32_t>(data + kE57PageData, std::endian::big) != e57_crc(data)) {
    fail_at_byte(input_, page * kE57Page, fmt::format("page {} is damaged (CRC)", page),
                 "Download or copy the file again");
  }
  checked_ = page;
}

}  // namespace palpate::io
