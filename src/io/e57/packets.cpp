// Decodes the packets of an E57 scan.
#include "io/e57/packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kSlack = 9;  // bytes: a number of 64 bits may begin inside a byte (derived)
constexpr std::string_view kFetchAgain = "The file is damaged: download or export it again";

}  // namespace

E57Column::E57Column(const E57Field& field) : field_(field), bytes_(kSlack) {}

void E57Column::append(std::span<const std::byte> bytes) {
  const auto taken = static_cast<std::ptrdiff_t>(next_ / 8);
  if (static_cast<std::size_t>(taken) > bytes_.size() / 2) {  // seldom, so that moving costs little
    bytes_.erase(bytes_.begin(), bytes_.begin() + taken);
    next_ %= 8;
  }
  bytes_.insert(bytes_.end() - kSlack, bytes.begin(), bytes.end());
}

std::uint64_t E57Column::available() const {
  if (field_.bits == 0) return std::numeric_limits<std::uint64_t>::max();
  return (8 * (bytes_.size() - kSlack) - next_) / field_.bits;
}

void E57Column::take(std::size_t count) {
  values_.resize(count);
  for (double& value : values_) {
    value = number(bits_at(next_));
    next_ += field_.bits;
  }
}

std::uint64_t E57Column::bits_at(std::uint64_t bit) const {
  const std::byte* at = bytes_.data() + bit / 8;
  const std::uint64_t skipped = bit % 8;
  std::uint64_t bits = load_as<std::uint64_t>(at) >> skipped;
  if (skipped > 0) bits |= std::to_integer<std::uint64_t>(at[8]) << (64 - skipped);
  return field_.bits == 64 ? bits : bits & ((std::uint64_t{1} << field_.bits) - 1);
}

double E57Column::number(std::uint64_t bits) const {
  if (field_.kind == E57Field::Kind::float32) {
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  }
  if (field_.kind == E57Field::Kind::float64) return std::bit_cast<double>(bits);
  const auto integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(field_.minimum) + bits);
  return static_cast<double>(integer) * field_.scale + field_.offset;
}

E57Packets::E57Packets(const Input& input, E57Pages& pages, const E57Scan& scan,
                       const std::vector<std::size_t>& used)
    : input_(input), pages_(pages), scan_(scan), used_(used) {
  constexpr std::uint64_t kSectionHeader = 32;  // bytes (format)
  pages.read(scan.section, kSectionHeader, packet_, "the section of a scan");
  const auto length = load_as<std::uint64_t>(packet_.data() + 8);
  if (packet_[0] != std::byte{1} || length > pages.size() - scan.section) {
    fail_at_byte(
        input, E57Pages::byte_of(scan.section),
        fmt::format("no section of points, or one that leaves the file ({} bytes)", length),
        kFetchAgain);
  }
  offset_ = E57Pages::logical_of(load_as<std::uint64_t>(packet_.data() + 16));
  end_ = scan.section + length;
  if (offset_ < scan.section || offset_ > end_) {
    fail_at_byte(input, E57Pages::byte_of(scan.section + 16), "points outside their section",
                 kFetchAgain);
  }
  for (const std::size_t field : used_) columns_.emplace_back(scan.fields[field]);
  check_room();
}

// A point takes a bit at least, so that a count alone allocates nothing.
void E57Packets::check_room() const {
  std::uint64_t bits = 0;
  for (const std::size_t field : used_) bits += scan_.fields[field].bits;
  const std::uint64_t most = 8 * bytes() / std::max<std::uint64_t>(bits, 1);
  if (scan_.points <= most) return;
  fail_at_byte(
      input_, E57Pages::byte_of(scan_.section),
      fmt::format("{} points of {} bits announced in {} bytes", scan_.points, bits, bytes()),
      kFetchAgain);
}

std::size_t E57Packets::next() {
  if (done_ == scan_.points) return 0;
  while (true) {
    if (const std::size_t count = take(); count > 0) return count;
    read_packet();
  }
}

std::size_t E57Packets::take() {
  constexpr std::uint64_t kMostAtOnce = 4096;  // points; their numbers fit a cache (judgement)
  std::uint64_t count = std::min(scan_.points - done_, kMostAtOnce);
  for (const E57Column& column : columns_) count = std::min(count, column.available());
  if (count == 0) return 0;
  for (E57Column& column : columns_) column.take(count);
  done_ += count;
  return count;
}

void E57Packets::read_packet() {
  constexpr std::uint64_t kPacketHeader = 4;  // bytes: type, flags, length - 1 (format)
  if (offset_ + kPacketHeader > end_) {
    fail_at_byte(input_, E57Pages::byte_of(offset_),
                 fmt::format("a scan ends after {} of {} points", done_, scan_.points),
                 kFetchAgain);
  }
  pages_.read(offset_, kPacketHeader, packet_, "a packet of points");
  const auto type = std::to_integer<int>(packet_[0]);
  const std::uint64_t length = load_as<std::uint16_t>(packet_.data() + 2) + std::uint64_t{1};
  if (type > 2 || length < kPacketHeader || length > end_ - offset_) {  // index, data, empty
    fail_at_byte(input_, E57Pages::byte_of(offset_),
                 fmt::format("a packet of type {} and {} bytes cannot be here", type, length),
                 kFetchAgain);
  }
  if (type == 1) {
    pages_.read(offset_, length, packet_, "a packet of points");
    split_packet();
  }
  offset_ += length;
}

// A data packet: the number of columns, the bytes of each, and these bytes one column after
// another.
void E57Packets::split_packet() {
  constexpr std::size_t kSizes = 6;  // where the sizes begin (format)
  const std::span<const std::byte> packet(packet_);
  const std::size_t count = packet.size() < kSizes ? 0 : load_as<std::uint16_t>(packet.data() + 4);
  std::size_t at = kSizes + 2 * count;
  bool whole = count == scan_.fields.size() && at <= packet.size();
  std::size_t column = 0;  // the next used one
  for (std::size_t k = 0; k < count && whole; ++k) {
    const std::size_t size = load_as<std::uint16_t>(packet.data() + kSizes + 2 * k);
    whole = size <= packet.size() - at;
    const bool used = column < used_.size() && used_[column] == k;
    if (whole && used) columns_[column++].append(packet.subspan(at, size));
    at += size;
  }
  if (whole) return;
  fail_at_byte(input_, E57Pages::byte_of(offset_),
               fmt::format("a packet of {} bytes does not hold what it announces", packet.size()),
               kFetchAgain);
}

}  // namespace palpate::io
