// Reads splats from .spz files, versions 1 to 4.
#include <fmt/format.h>
#include <zstd.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/splats/splats.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kNewest = 4;          // version (format)
constexpr std::size_t kSmallHeader = 16;    // bytes, up to version 3 (format)
constexpr std::size_t kLargeHeader = 32;    // bytes, version 4 (format)
constexpr std::size_t kTableRow = 16;       // bytes a stream (format)
constexpr std::uint8_t kMostFraction = 23;  // bits of a coordinate of 24 (format)
constexpr const char* kDownload = "Download or export it again";

struct SpzHeader {
  std::size_t version = 0;
  std::size_t count = 0;
  std::uint8_t fraction = 0;  // bits of a coordinate that are a fraction
  std::uint8_t streams = 0;   // version 4
  std::size_t table = 0;      // byte at which the table of streams begins

  [[nodiscard]] bool has_wide_turns() const { return version >= 3; }
};

// The columns in the order of the file; those behind them are not read.
enum Column { kPositions, kAlphas, kColors, kScales, kTurns };
constexpr std::array<const char*, 5> kColumnNames{"positions", "alphas", "colours", "scales",
                                                  "rotations"};

// Bytes a splat in each column.
std::array<std::size_t, 5> sizes_of(const SpzHeader& header) {
  return {header.version == 1 ? 6U : 9U, 1, 3, 3, header.has_wide_turns() ? 4U : 3U};
}

SpzHeader read_spz_header(const Input& input) {
  const std::byte* bytes = input.bytes.data();
  if (input.bytes.size() < kSmallHeader) {
    fail_at_byte(input, input.bytes.size(), "the header is cut", kDownload);
  }
  SpzHeader header;
  header.version = load_as<std::uint32_t>(bytes + 4);
  header.count = load_as<std::uint32_t>(bytes + 8);
  header.fraction = std::to_integer<std::uint8_t>(bytes[13]);
  if (header.version == 0 || header.version > kNewest) {
    fail_at_byte(input, 4,
                 fmt::format("version {} is {} than this program reads (1 to {})", header.version,
                             header.version == 0 ? "older" : "newer", kNewest),
                 "Export it as PLY");
  }
  if (header.version > 1 && header.fraction > kMostFraction) {
    fail_at_byte(input, 13, fmt::format("{} fractional bits of 24", header.fraction), kDownload);
  }
  if (header.version < 4) return header;
  if (input.bytes.size() < kLargeHeader) {
    fail_at_byte(input, input.bytes.size(), "the header is cut", kDownload);
  }
  header.streams = std::to_integer<std::uint8_t>(bytes[15]);
  header.table = load_as<std::uint32_t>(bytes + 16);
  return header;
}

using SpzColumns = std::array<std::span<const std::byte>, 5>;

[[noreturn]] void fail_column(const Input& input, std::size_t column, std::size_t there,
                              std::size_t wanted) {
  fail(input,
       fmt::format("stream {} ({}) ends after {} of {} bytes", column, kColumnNames[column], there,
                   wanted),
       kDownload);
}

// Columns that follow one another, as up to version 3.
SpzColumns plain_columns(const Input& input, const SpzHeader& header) {
  SpzColumns columns;
  std::size_t at = kSmallHeader;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t wanted = header.count * sizes_of(header)[k];
    const std::size_t there = input.bytes.size() - at;
    if (there < wanted) fail_column(input, k, there, wanted);
    columns[k] = input.bytes.subspan(at, wanted);
    at += wanted;
  }
  return columns;
}

// One stream of version 4.
Bytes unpack_stream(const Input& input, std::size_t column, std::span<const std::byte> packed,
                    std::size_t wanted) {
  Bytes bytes(wanted);
  const std::size_t got =
      ZSTD_decompress(bytes.span().data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0) {
    fail(input,
         fmt::format("stream {} ({}) cannot be unpacked: {}", column, kColumnNames[column],
                     ZSTD_getErrorName(got)),
         kDownload);
  }
  if (got != wanted) fail_column(input, column, got, wanted);
  return bytes;
}

void check_streams(const Input& input, const SpzHeader& header) {
  const std::size_t size = header.streams * kTableRow;
  if (header.streams < kColumnNames.size()) {
    fail_at_byte(input, 15, fmt::format("{} streams; a scene has 5 at least", header.streams),
                 kDownload);
  }
  const bool inside = header.table >= kLargeHeader && header.table <= input.bytes.size() &&
                      input.bytes.size() - header.table >= size;
  if (!inside) {
    fail_at_byte(
        input, 16,
        fmt::format("the table of streams is at byte {} of {}", header.table, input.bytes.size()),
        kDownload);
  }
  std::size_t row = 0;
  for (const std::size_t size_of_column : sizes_of(header)) row += size_of_column;
  if (header.count > largest_unpacked(input.bytes.size()) / row) {
    fail_at_byte(input, 8,
                 fmt::format("{} splats do not fit {} bytes", header.count, input.bytes.size()),
                 kDownload);
  }
}

// The columns of version 4, unpacked into `memory`.
SpzColumns packed_columns(const Input& input, const SpzHeader& header,
                          std::array<Bytes, 5>& memory) {
  check_streams(input, header);
  SpzColumns columns;
  std::size_t at = header.table + header.streams * kTableRow;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::byte* row = input.bytes.data() + header.table + k * kTableRow;
    const auto packed = load_as<std::uint64_t>(row);
    const auto unpacked = load_as<std::uint64_t>(row + 8);
    const std::size_t wanted = header.count * sizes_of(header)[k];
    const std::size_t there = input.bytes.size() - at;
    if (packed > there) fail_column(input, k, there, packed);
    if (unpacked != wanted) fail_column(input, k, unpacked, wanted);
    memory[k] = unpack_stream(input, k, input.bytes.subspan(at, packed), wanted);
    columns[k] = std::as_const(memory[k]).span();
    at += packed;
  }
  return columns;
}

float number_of(std::byte byte) {
  return std::to_integer<std::uint8_t>(byte);
}

// A position in the file's axes: right, up, back.
Eigen::Vector3f position_at(const SpzHeader& header, const std::byte* at) {
  Eigen::Vector3f position;
  for (int k = 0; k < 3; ++k) {
    if (header.version == 1) {
      const auto bits = load_as<std::uint16_t>(at + 2 * k);
      position[k] = static_cast<float>(Eigen::half(Eigen::half_impl::raw_uint16_to_half(bits)));
      continue;
    }
    const auto byte = [&](int b) { return std::to_integer<std::uint32_t>(at[3 * k + b]); };
    const auto number =
        static_cast<std::int32_t>(byte(0) << 8 | byte(1) << 16 | byte(2) << 24) >> 8;
    position[k] = std::ldexp(static_cast<float>(number), -header.fraction);
  }
  return position;
}

// x y z w.
Eigen::Vector4f turn_at(const SpzHeader& header, const std::byte* at) {
  Eigen::Vector3f others;
  if (!header.has_wide_turns()) {
    for (int k = 0; k < 3; ++k) others[k] = number_of(at[k]) / 127.5F - 1;
    return with_largest(3, others);
  }
  auto word = load_as<std::uint32_t>(at);
  const std::uint32_t largest = word >> 30;
  for (int k = 2; k >= 0; --k, word >>= 10) {  // the last of them lies lowest
    const float size = static_cast<float>(word & 511) / 511 / std::numbers::sqrt2_v<float>;
    others[k] = (word & 512) != 0 ? -size : size;
  }
  return with_largest(largest, others);
}

Splat splat_at(const SpzHeader& header, const SpzColumns& columns, std::size_t i) {
  const auto at = [&](Column column) {
    return columns[column].data() + i * sizes_of(header)[column];
  };
  Splat splat;
  const Eigen::Vector3f position = position_at(header, at(kPositions));
  splat.position = {position.x(), -position.y(), -position.z()};
  splat.opacity = number_of(*at(kAlphas)) / 255;
  Eigen::Vector3d color;
  for (int k = 0; k < 3; ++k) {
    color[k] = (static_cast<double>(number_of(at(kColors)[k])) / 255 - 0.5) / 0.15;
    splat.sigma[k] = std::exp(number_of(at(kScales)[k]) / 16 - 10);
  }
  splat.color = color_of(color);
  const Eigen::Vector4f turn = turn_at(header, at(kTurns));
  splat.rotation = {turn[3], turn[0], -turn[1], -turn[2]};
  return splat;
}

}  // namespace

SplatFile read_spz(const Input& input) {
  const SpzHeader header = read_spz_header(input);
  std::array<Bytes, 5> memory;
  const SpzColumns columns =
      header.version < 4 ? plain_columns(input, header) : packed_columns(input, header, memory);
  SplatFile file{.format = fmt::format("SPZ {}", header.version)};
  file.splats.reserve(header.count);
  Progress progress(input.options, header.count);
  for (std::size_t i = 0; i < header.count; ++i) {
    file.add(splat_at(header, columns, i), input.unit.plan);
    progress.at(i);
  }
  return file;
}

}  // namespace palpate::io
