// Compresses LAS files for tests, as no package of Debian does.
#include "io/laz_encoder.hpp"

#include "io/laz_encoder_inside.hpp"
#include "io/reading.hpp"

namespace palpate {
namespace {

struct Item {
  int type;
  std::size_t size;
};

std::vector<Item> items_of(int format, std::size_t record) {
  std::vector<Item> items;
  if (format < 6) {
    items.push_back({6, 20});
    if (format == 1 || format == 3) items.push_back({7, 8});
    if (format >= 2) items.push_back({8, 6});
  } else {
    items.push_back({10, 30});
    if (format == 7) items.push_back({11, 6});
    if (format == 8) items.push_back({12, 8});
  }
  for (const Item& item : std::vector(items)) record -= item.size;
  if (record > 0) items.push_back({format < 6 ? 0 : 14, record});
  return items;
}

// The record "laszip encoded" with its own header.
std::string description(int format, std::size_t record, std::uint32_t chunk) {
  const std::vector<Item> items = items_of(format, record);
  std::string bytes(54, '\0');
  bytes.replace(2, 14, "laszip encoded");
  overwrite<std::uint16_t>(bytes, 18, 22204);
  overwrite<std::uint16_t>(bytes, 20, static_cast<std::uint16_t>(34 + 6 * items.size()));
  append<std::uint16_t>(bytes, format < 6 ? 2 : 3);
  for (const int version : {0, 0x0303, 0})
    append<std::uint16_t>(bytes, static_cast<std::uint16_t>(version));
  append<std::uint32_t>(bytes, 0);
  append(bytes, chunk);
  append<std::int64_t>(bytes, -1);
  append<std::int64_t>(bytes, -1);
  append(bytes, static_cast<std::uint16_t>(items.size()));
  for (const Item& item : items) {
    append(bytes, static_cast<std::uint16_t>(item.type));
    append(bytes, static_cast<std::uint16_t>(item.size));
    append<std::uint16_t>(bytes, format < 6 ? 2 : 3);
  }
  return bytes;
}

struct Sizes {
  std::uint32_t points;
  std::uint32_t bytes;
};

std::string table_of(const std::vector<Sizes>& chunks, bool varying) {
  std::string bytes;
  append<std::uint32_t>(bytes, 0);
  append(bytes, static_cast<std::uint32_t>(chunks.size()));
  RangeEncoder out;
  NumberEncoder sizes(32, 2);
  Sizes last{};
  for (const Sizes& chunk : chunks) {
    if (varying) sizes.encode(out, last.points, chunk.points, 0);
    sizes.encode(out, last.bytes, chunk.bytes, 1);
    last = chunk;
  }
  return bytes + out.finish();
}

}  // namespace

std::string laz_of(std::string_view las, const LazWriting& writing) {
  const int format = load<std::uint8_t>(las, 104);
  const std::size_t record = load<std::uint16_t>(las, 105);
  const std::size_t begin = load<std::uint32_t>(las, 96);
  const std::size_t header = load<std::uint16_t>(las, 94);
  std::string bytes = std::string(las.substr(0, header)) + writing.record;
  bytes += description(format, record, writing.varying ? 0xFFFFFFFFU : writing.chunk);
  overwrite<std::uint32_t>(bytes, 100, writing.record.empty() ? 1 : 2);
  overwrite<std::uint32_t>(bytes, 96, static_cast<std::uint32_t>(bytes.size()));
  overwrite(bytes, 104, static_cast<std::uint8_t>(format | 128));
  const std::size_t place = bytes.size();
  append<std::int64_t>(bytes, -1);
  std::vector<std::string_view> records;
  for (std::size_t at = begin; at + record <= las.size(); at += record) {
    records.push_back(las.substr(at, record));
  }
  std::vector<Sizes> chunks;
  for (std::span<const std::string_view> rest = records; !rest.empty();) {
    const std::size_t wanted =
        writing.varying ? 1 + 7919 * chunks.size() % writing.chunk : writing.chunk;
    const auto part = rest.first(std::min(wanted, rest.size()));
    rest = rest.subspan(part.size());
    const std::string chunk =
        format < 6 ? encode_chunk_10(format, part) : encode_chunk_14(format, part);
    bytes += chunk;
    chunks.push_back(
        {static_cast<std::uint32_t>(part.size()), static_cast<std::uint32_t>(chunk.size())});
  }
  const auto table = static_cast<std::int64_t>(bytes.size());
  if (!writing.place_at_end) overwrite(bytes, place, table);
  bytes += table_of(chunks, writing.varying);
  if (writing.place_at_end) append(bytes, table);
  return bytes;
}

}  // namespace palpate
