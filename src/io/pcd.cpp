// Reads the points of PCD files: ascii, binary and compressed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "io/cloud_builder.hpp"
#include "io/file_bytes.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/table.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

struct FieldUses {
  Roles roles;                     // one a field
  std::optional<std::size_t> rgb;  // the field that packs a colour
};

FieldUses uses_of(const Input& input, const PcdHeader& header) {
  FieldUses result;
  for (const PcdField& field : header.fields) {
    const bool packed = field.count > 0 && size_of(field.type) == 4 &&
                        (field.name == "rgb" || field.name == "rgba");
    if (packed && !result.rgb) result.rgb = result.roles.size();
    result.roles.add(field.count > 0 ? role_of(field.name) : std::nullopt);
  }
  if (!result.roles.has_point()) {
    fail(input, "the FIELDS of this PCD file lack x, y or z", "Export it again with positions");
  }
  return result;
}

void set_packed_color(Row& row, std::uint32_t bits) {
  row[index_of(Role::red)] = static_cast<double>((bits >> 16U) & 255U);
  row[index_of(Role::green)] = static_cast<double>((bits >> 8U) & 255U);
  row[index_of(Role::blue)] = static_cast<double>(bits & 255U);
}

// In text a packed colour of type F is the float of its bits, of type U or I the number itself.
std::uint32_t color_bits(NumberType type, double value) {
  if (type == NumberType::float32) {
    return std::isfinite(value) ? std::bit_cast<std::uint32_t>(static_cast<float>(value)) : 0U;
  }
  const bool fits = value >= -2147483648.0 && value <= 4294967295.0;
  return fits ? static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) : 0U;
}

class PcdReader {
 public:
  explicit PcdReader(const Input& input)
      : input_(input),
        header_(read_pcd_header(input)),
        uses_(uses_of(input, header_)),
        data_(input.bytes.subspan(header_.size)) {}

  CloudFile run() {
    if (header_.encoding == PcdEncoding::ascii) return finish(read_ascii(), "PCD, ascii");
    if (header_.encoding == PcdEncoding::binary) return finish(read_binary(), "PCD, binary");
    return finish(read_compressed(), "PCD, binary compressed");
  }

 private:
  CloudBuilder builder(std::size_t room) const {
    Columns columns = uses_.roles.columns();
    columns.colors = columns.colors || uses_.rgb;
    CloudBuilder result(input_, columns, ColorScale::byte, std::min(header_.points, room));
    if (header_.organised()) result.organise(header_.width, header_.height);
    return result;
  }

  CloudBuilder read_ascii() {
    CloudBuilder result = builder((data_.size() + 1) / (2 * header_.fields.size()) + 1);
    const std::vector<std::optional<std::size_t>> slots = ascii_slots();
    Progress progress(input_.options, input_.bytes.size());
    TableRows rows(input_, header_.size);
    std::array<double, kRoleCount + 1> values{};
    Row row{};
    for (std::size_t i = 0; i < header_.points; ++i) {
      if (!rows.next() || !rows.read(slots, values)) fail_cut(i);
      std::copy_n(values.begin(), kRoleCount, row.begin());
      if (uses_.rgb) {
        set_packed_color(row, color_bits(header_.fields[*uses_.rgb].type, values[kRoleCount]));
      }
      result.add(row);
      progress.at(rows.offset());
    }
    unused_ = rows_from(input_, rows.offset());
    return result;
  }

  // Where each number of a row of text goes; a packed colour goes behind the roles.
  std::vector<std::optional<std::size_t>> ascii_slots() const {
    std::vector<std::optional<std::size_t>> slots;
    for (std::size_t k = 0; header_.points > 0 && k < header_.fields.size(); ++k) {
      const std::size_t count = header_.fields[k].count;
      if (count > data_.size() - slots.size()) fail_cut(0);
      slots.resize(slots.size() + count);
      if (count == 0) continue;
      std::optional<std::size_t>& first = slots[slots.size() - count];
      if (const auto role = uses_.roles[k]) first = index_of(*role);
      if (uses_.rgb == k) first = kRoleCount;
    }
    return slots;
  }

  CloudBuilder read_binary() {
    const std::size_t present = data_.size() / header_.point_size;
    if (present < header_.points) fail_cut(present);
    unused_ = present - header_.points;
    CloudBuilder result = builder(present);
    Progress progress(input_.options, header_.points);
    Row row{};
    for (std::size_t i = 0; i < header_.points; ++i) {
      const std::byte* point = data_.data() + i * header_.point_size;
      for (std::size_t k = 0; k < header_.fields.size(); ++k) {
        read_field(k, point + header_.fields[k].offset, row);
      }
      result.add(row);
      progress.at(i);
    }
    return result;
  }

  // Compressed points are stored field by field: all of x, then all of y, ...
  CloudBuilder read_compressed() {
    const Bytes bytes = unpack();
    CloudBuilder result = builder(header_.points);
    Progress progress(input_.options, header_.points);
    Row row{};
    for (std::size_t i = 0; i < header_.points; ++i) {
      for (std::size_t k = 0; k < header_.fields.size(); ++k) {
        const PcdField& field = header_.fields[k];
        const std::size_t size = size_of(field.type) * field.count;
        read_field(k, bytes.span().data() + field.offset * header_.points + i * size, row);
      }
      result.add(row);
      progress.at(i);
    }
    return result;
  }

  void read_field(std::size_t k, const std::byte* at, Row& row) const {
    if (const auto role = uses_.roles[k]) {
      row[index_of(*role)] = load_number(header_.fields[k].type, at);
    }
    if (uses_.rgb == k) set_packed_color(row, load_as<std::uint32_t>(at));
  }

  Bytes unpack() const {
    constexpr std::size_t kSizes = 8;  // two 32-bit sizes come first: packed, unpacked
    if (data_.size() < kSizes) fail_cut(0);
    const std::size_t packed = load_as<std::uint32_t>(data_.data());
    const std::size_t unpacked = load_as<std::uint32_t>(data_.data() + 4);
    if (header_.points > unpacked / header_.point_size ||
        unpacked != header_.points * header_.point_size) {
      fail_at_byte(input_, header_.size + 4,
                   fmt::format("{} bytes of data declared for {} points of {} bytes", unpacked,
                               header_.points, header_.point_size),
                   "The file is damaged: download or export it again");
    }
    if (data_.size() - kSizes < packed || unpacked / kLzfLargestRatio > packed) {
      fail_at_byte(
          input_, header_.size,
          fmt::format("{} compressed bytes declared, {} present", packed, data_.size() - kSizes),
          "The file is truncated, and compressed data cannot be used in part: download it again");
    }
    Bytes bytes(unpacked);
    if (const auto wrong = lzf_unpack(data_.subspan(kSizes, packed), bytes.span())) {
      fail_at_byte(input_, header_.size + kSizes + *wrong, "the compressed data is damaged",
                   "Download or export the file again");
    }
    return bytes;
  }

  CloudFile finish(CloudBuilder result, std::string format) const {
    CloudFile file = result.finish(std::move(format) + unused(unused_));
    const bool is_set = header_.viewpoint != PcdHeader{}.viewpoint;
    const Eigen::Vector3d stand =
        input_.scale().cwiseProduct(Eigen::Map<const Eigen::Vector3d>(header_.viewpoint.data()));
    if ((is_set || header_.organised()) && is_usable(stand)) file.cloud.viewpoint = stand;
    return file;
  }

  [[noreturn]] void fail_cut(std::size_t present) const {
    fail_at_byte(input_, input_.bytes.size(),
                 fmt::format("the file ends after {} of {} points", present, header_.points),
                 fmt::format("Download or export it again; to use the points that are present, "
                             "write WIDTH {}, HEIGHT 1 and POINTS {} in its header",
                             present, present));
  }

  const Input& input_;
  PcdHeader header_;
  FieldUses uses_;
  std::span<const std::byte> data_;
  std::size_t unused_ = 0;  // points behind the last declared one
};

}  // namespace

CloudFile read_pcd(const Input& input) {
  return PcdReader(input).run();
}

}  // namespace palpate::io
