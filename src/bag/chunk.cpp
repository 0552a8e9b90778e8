// Packs and unpacks the chunks of MCAP files, within limits.
#include "bag/chunk.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include "bag/lz4.hpp"

namespace palpate::bag {

namespace {

// Bytes that may be packed to any ratio, as empty images pack well (judgement)
constexpr std::uint64_t kHarmless = 16 << 20;
constexpr std::uint64_t kLargestRatio = 1000;  // unpacked over packed bytes (judgement)

bool grows_beyond_reason(std::uint64_t size, std::uint64_t packed) {
  return size > kLargestChunk || (size > kHarmless && size / kLargestRatio > packed);
}

bool unpack_zstd(View from, Bytes& to) {
  const std::size_t size = ZSTD_decompress(to.data(), to.size(), from.data(), from.size());
  return ZSTD_isError(size) == 0 && size == to.size();
}

}  // namespace

Packed pack(View records) {
  Packed packed{"zstd", Bytes(ZSTD_compressBound(records.size()))};
  const std::size_t size =
      ZSTD_compress(packed.bytes.data(), packed.bytes.size(), records.data(), records.size(), 1);
  if (ZSTD_isError(size) != 0 || size >= records.size() ||
      grows_beyond_reason(records.size(), size)) {
    return {};
  }
  packed.bytes.resize(size);
  return packed;
}

Bytes unpack(View chunk) {
  Fields fields(chunk);
  fields.bytes(2 * sizeof(std::uint64_t));  // times
  const auto size = fields.number<std::uint64_t>();
  const auto crc = fields.number<std::uint32_t>();
  const std::string compression = fields.text();
  const View packed = fields.bytes(fields.number<std::uint64_t>());
  if (grows_beyond_reason(size, packed.size())) {
    throw Error(
        fmt::format("{} bytes that are said to become {} are refused", packed.size(), size));
  }
  Bytes records;
  bool whole = true;
  if (compression.empty()) {
    whole = size == packed.size();
    records.assign(packed.begin(), packed.end());
  } else if (compression == "zstd" || compression == "lz4") {
    records.resize(size);
    whole = compression == "zstd" ? unpack_zstd(packed, records) : unpack_lz4(packed, records);
  } else {
    throw Error("its compression is not known; lz4 and zstd are");
  }
  if (!whole) throw Error("its bytes cannot be unpacked");
  if (crc != 0 && crc_of(records) != crc) throw Error("its bytes do not have the CRC they should");
  return records;
}

}  // namespace palpate::bag
