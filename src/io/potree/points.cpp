// Decodes the points of the nodes of Potree stores.
#include "io/potree/points.hpp"

#include <brotli/decode.h>
#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "io/file_bytes.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::potree {
namespace {

// Every third bit of the lower 48, from bit 0 on, side by side.
std::uint32_t every_third(std::uint64_t v) {
  v &= 0x249249249249;
  v = (v | v >> 2) & 0xC30C30C30C3;
  v = (v | v >> 4) & 0xF00F00F00F;
  v = (v | v >> 8) & 0xFF0000FF;
  return static_cast<std::uint32_t>((v | v >> 16) & 0xFFFF);
}

Bytes unpack(const StoredNode& node, std::span<const std::byte> bytes, std::size_t size,
             const std::string& octree) {
  Bytes unpacked(size);
  std::size_t done = size;
  const BrotliDecoderResult result =
      BrotliDecoderDecompress(bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()),
                              &done, reinterpret_cast<std::uint8_t*>(unpacked.span().data()));
  if (result != BROTLI_DECODER_RESULT_SUCCESS || done != size) {
    throw Error(
        fmt::format("{}, byte {}: node {} is damaged: its brotli data do not unpack to {} "
                    "bytes. Copy it again.",
                    octree, node.offset, name_of(node.node), size));
  }
  return unpacked;
}

// Where an attribute of the points is: of the first, and bytes from one to the next.
struct Column {
  const std::byte* begin = nullptr;
  std::size_t stride = 0;

  const std::byte* operator[](std::size_t point) const { return begin + point * stride; }
};

std::array<std::int32_t, 3> number_at(const std::byte* bytes, bool packed) {
  std::array<std::int32_t, 3> number{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (packed) {
      const std::uint32_t upper = every_third(load_as<std::uint64_t>(bytes) >> k);
      const std::uint32_t lower = every_third(load_as<std::uint64_t>(bytes + 8) >> k);
      number[k] = static_cast<std::int32_t>(upper << 16U | lower);
    } else {
      number[k] = load_as<std::int32_t>(bytes + 4 * k);
    }
  }
  return number;
}

std::array<std::uint16_t, 3> color_at(const std::byte* bytes, bool packed) {
  std::array<std::uint16_t, 3> color{};
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] = packed ? static_cast<std::uint16_t>(every_third(load_as<std::uint64_t>(bytes) >> k))
                      : load_as<std::uint16_t>(bytes + 2 * k);
  }
  return color;
}

float intensity_at(const std::byte* bytes, NumberType type) {
  const auto value = static_cast<float>(load_number(type, bytes));
  return std::isfinite(value) ? value : 0.0F;
}

std::vector<RawPoint> points_of(const Metadata& metadata, const std::byte* bytes,
                                std::size_t count) {
  const auto column = [&](const Attribute& attribute) {
    if (!metadata.packed) return Column{bytes + attribute.offset, metadata.point_size};
    return Column{bytes + count * attribute.offset, attribute.bytes};
  };
  std::vector<RawPoint> points(count);
  const Column numbers = column(metadata.position);
  for (std::size_t i = 0; i < count; ++i) {
    points[i].number = number_at(numbers[i], metadata.packed);
  }
  if (metadata.color) {
    const Column colors = column(*metadata.color);
    for (std::size_t i = 0; i < count; ++i) {
      points[i].color = color_at(colors[i], metadata.packed);
    }
  }
  if (metadata.intensity) {
    const Column intensities = column(*metadata.intensity);
    for (std::size_t i = 0; i < count; ++i) {
      points[i].intensity = intensity_at(intensities[i], metadata.intensity->type);
    }
  }
  return points;
}

}  // namespace

std::vector<RawPoint> decode(const Metadata& metadata, const StoredNode& node,
                             std::span<const std::byte> bytes, const std::string& octree) {
  const std::size_t count = node.node.points;
  if (count == 0) return {};
  if (!metadata.packed) return points_of(metadata, bytes.data(), count);
  const Bytes unpacked = unpack(node, bytes, count * metadata.point_size, octree);
  return points_of(metadata, unpacked.span().data(), count);
}

}  // namespace palpate::io::potree
