// Walks through the rows of PLY files, as text or as bytes of either order.
#include "io/ply_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "io/table.hpp"
#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io {
namespace {

// Two variants that get the next number of an element; false at the end of the bytes.
class AsciiCursor {
 public:
  AsciiCursor(const Input& input, std::size_t offset) : input_(input), scanner_(input, offset) {}
  bool next(NumberType, double& value) {
    const std::optional<double> number = scanner_.next_number();
    value = number.value_or(0);
    return number.has_value();
  }
  bool skip(NumberType, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (scanner_.next_token().empty()) return false;
    }
    return true;
  }
  void begin_row() { scanner_.begin_row(); }
  [[nodiscard]] std::size_t rows_left(const PlyElement&) const {
    return rows_from(input_, offset());
  }
  [[nodiscard]] TextRow row() const { return scanner_.row(); }
  [[nodiscard]] bool row_ends() const { return scanner_.at_line_end(); }
  [[nodiscard]] std::size_t offset() const { return scanner_.offset(); }
  static std::size_t least_size(NumberType) { return 2; }  // a digit and a space

 private:
  const Input& input_;
  TextScanner scanner_;
};

class BinaryCursor {
 public:
  BinaryCursor(const Input& input, std::size_t offset, std::endian order)
      : bytes_(input.bytes), offset_(offset), order_(order) {}
  bool next(NumberType type, double& value) {
    if (bytes_.size() - offset_ < size_of(type)) return false;
    value = load_number(type, bytes_.data() + offset_, order_);
    offset_ += size_of(type);
    return true;
  }
  bool skip(NumberType type, std::size_t count) {
    if ((bytes_.size() - offset_) / size_of(type) < count) return false;
    offset_ += count * size_of(type);
    return true;
  }
  void begin_row() {}
  [[nodiscard]] std::size_t rows_left(const PlyElement& last) const {
    std::size_t size = 0;
    for (const PlyProperty& property : last.properties) {
      if (property.list_count) return 0;
      size += size_of(property.type);
    }
    return size > 0 ? (bytes_.size() - offset_) / size : 0;
  }
  [[nodiscard]] static TextRow row() { return {}; }
  [[nodiscard]] static bool row_ends() { return true; }
  [[nodiscard]] std::size_t offset() const { return offset_; }
  static std::size_t least_size(NumberType type) { return size_of(type); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_;
  std::endian order_;
};

// Bytes of the smallest row.
std::size_t least_row(const PlyElement& element, bool ascii) {
  std::size_t size = 0;
  for (const PlyProperty& p : element.properties) {
    const NumberType type = p.list_count.value_or(p.type);
    size += ascii ? AsciiCursor::least_size(type) : BinaryCursor::least_size(type);
  }
  return size;
}

template <class Cursor>
class PlyReader {
 public:
  PlyReader(const Input& input, Cursor cursor)
      : input_(input), cursor_(std::move(cursor)), progress_(input.options, input.bytes.size()) {}

  std::size_t run(const PlyHeader& header, std::span<PlyTable> tables) {
    for (const PlyElement& element : header.elements) {
      if (tables.empty() && !odd_) return 0;
      if (tables.empty() || tables.front().element != &element) {
        skip_element(element);
      } else {
        read_rows(tables.front());
        tables = tables.subspan(1);
      }
      if (odd_ && !cursor_.row_ends()) fail_at_row(input_, *odd_);
    }
    cursor_.begin_row();
    if (odd_ && cursor_.offset() < input_.bytes.size()) fail_at_row(input_, *odd_);
    return cursor_.rows_left(header.elements.back());
  }

 private:
  void read_rows(PlyTable& table) {
    const PlyElement& element = *table.element;
    for (std::size_t i = 0; i < element.count; ++i) {
      cursor_.begin_row();
      if (!read_row(table)) fail_cut(element, i);
      end_row();
      take(table);
      progress_.at(cursor_.offset());
    }
  }

  // What is wrong with values that are not this row's own is where they come from.
  void take(const PlyTable& table) const {
    try {
      table.take(table.row);
    } catch (const Error&) {
      if (odd_) fail_at_row(input_, *odd_);
      throw;
    }
  }

  // Rows may go on over lines, and lines over rows, as long as all their values fit in the end.
  void end_row() {
    if (!odd_ && !cursor_.row_ends()) odd_ = cursor_.row();
  }

  bool read_row(PlyTable& table) {
    const PlyElement& element = *table.element;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      double value = 0;
      if (property.list_count) {
        if (!(table.list == k ? read_list(property, table) : skip_list(property))) return false;
      } else if (!table.slots[k]) {
        if (!cursor_.skip(property.type, 1)) return false;
      } else if (cursor_.next(property.type, value)) {
        table.row[*table.slots[k]] = value;
      } else {
        return false;
      }
    }
    return true;
  }

  void skip_element(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::size_t i = 0; i < element.count; ++i) {
      cursor_.begin_row();
      for (const PlyProperty& property : element.properties) {
        const bool there =
            property.list_count ? skip_list(property) : cursor_.skip(property.type, 1);
        if (!there) fail_cut(element, i);
      }
      end_row();
      progress_.at(cursor_.offset());
    }
  }

  bool skip_list(const PlyProperty& property) {
    double length = 0;
    return read_length(property, length) &&
           cursor_.skip(property.type, static_cast<std::size_t>(length));
  }

  bool read_list(const PlyProperty& property, PlyTable& table) {
    table.list_begin = cursor_.offset();
    table.items.clear();
    double length = 0;
    if (!read_length(property, length)) return false;
    for (double k = 0; k < length; ++k) {
      if (!cursor_.next(property.type, table.items.emplace_back())) return false;
    }
    return true;
  }

  bool read_length(const PlyProperty& property, double& length) {
    const std::size_t begin = cursor_.offset();
    if (!cursor_.next(*property.list_count, length)) return false;
    if (length >= 0 && length <= 4294967295.0) return true;
    if (odd_) fail_at_row(input_, *odd_);
    fail_at_byte(input_, begin, fmt::format("invalid list length {}", length),
                 "The file is damaged: export it again");
  }

  [[noreturn]] void fail_cut(const PlyElement& element, std::size_t present) const {
    if (odd_) fail_at_row(input_, *odd_);
    fail_at_byte(input_, input_.bytes.size(),
                 fmt::format("the file ends after {} of {} rows of \"{}\"", present, element.count,
                             excerpt(element.name)),
                 fmt::format("Download or export it again; to use the {} rows that are present, "
                             "write \"element {} {}\" in its header",
                             present, excerpt(element.name), present));
  }

  const Input& input_;
  Cursor cursor_;
  Progress progress_;
  std::optional<TextRow> odd_;  // the first row that ends within a line
};

}  // namespace

PlyTable table_of(const PlyElement& element, std::span<const std::string_view> names,
                  double absent) {
  PlyTable table{.element = &element, .row = std::vector<double>(names.size(), absent)};
  for (const PlyProperty& property : element.properties) {
    const auto found = std::ranges::find(names, property.name);
    const bool wanted = found != names.end() && !property.list_count;
    table.slots.push_back(wanted ? std::optional<std::size_t>(found - names.begin())
                                 : std::nullopt);
  }
  return table;
}

std::size_t read_ply_rows(const Input& input, const PlyHeader& header, std::span<PlyTable> tables) {
  if (header.encoding == PlyEncoding::ascii) {
    return PlyReader(input, AsciiCursor(input, header.size)).run(header, tables);
  }
  const bool little = header.encoding == PlyEncoding::little_endian;
  const BinaryCursor cursor(input, header.size, little ? std::endian::little : std::endian::big);
  return PlyReader(input, cursor).run(header, tables);
}

std::size_t most_rows(const Input& input, const PlyHeader& header, const PlyElement& element) {
  const std::size_t row = least_row(element, header.encoding == PlyEncoding::ascii);
  return std::min(element.count,
                  (input.bytes.size() - header.size + 1) / std::max<std::size_t>(row, 1));
}

std::string_view name_of(PlyEncoding encoding) {
  if (encoding == PlyEncoding::ascii) return "PLY, ascii";
  return encoding == PlyEncoding::little_endian ? "PLY, binary little endian"
                                                : "PLY, binary big endian";
}

}  // namespace palpate::io
