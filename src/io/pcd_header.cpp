// Parses the header of PCD files.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/formats.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::size_t kMostFields = 4096;     // fields; no honest file has more (judgement)
constexpr std::size_t kLargestCount = 65536;  // numbers in one field of one point (judgement)

std::vector<std::string_view> words_of(std::string_view rest) {
  std::vector<std::string_view> words;
  while (true) {
    const std::string_view word = take_word(rest);
    if (word.empty()) return words;
    words.push_back(word);
  }
}

class PcdHeaderParser {
 public:
  explicit PcdHeaderParser(const Input& input) : input_(input), scanner_(input) {}

  PcdHeader run() {
    while (!has_data_) {
      if (scanner_.at_end()) {
        fail(input_, "the PCD header has no DATA line", "The file is truncated: download it again");
      }
      line_begin_ = scanner_.offset();
      std::string_view line = scanner_.next_line();
      const std::string_view keyword = take_word(line);
      if (keyword.empty() || keyword.front() == '#') continue;
      take(keyword, words_of(line));
    }
    make_fields();
    make_size();
    header_.size = scanner_.offset();
    return std::move(header_);
  }

 private:
  using Words = std::vector<std::string_view>;

  void take(std::string_view keyword, Words words) {
    if (keyword == "VERSION") return;
    if (keyword == "FIELDS" || keyword == "COLUMNS") return void(names_ = std::move(words));
    if (keyword == "SIZE") return void(sizes_ = std::move(words));
    if (keyword == "TYPE") return void(types_ = std::move(words));
    if (keyword == "COUNT") return void(counts_ = std::move(words));
    if (keyword == "WIDTH") return void(width_ = count(words));
    if (keyword == "HEIGHT") return void(header_.height = count(words));
    if (keyword == "POINTS") return void(points_ = count(words));
    if (keyword == "VIEWPOINT") return take_viewpoint(words);
    if (keyword == "DATA") return take_data(words);
    wrong(fmt::format("unknown word \"{}\" in the PCD header", excerpt(keyword)));
  }

  std::size_t count(const Words& words) {
    const std::optional<std::size_t> number =
        words.size() == 1 ? parse_count(words[0]) : std::nullopt;
    if (!number) wrong("expected a single whole number");
    return *number;
  }

  void take_viewpoint(const Words& words) {
    if (words.size() != 7) wrong("VIEWPOINT needs seven numbers: x y z and qw qx qy qz");
    for (std::size_t i = 0; i < 7; ++i) {
      const std::optional<double> number = parse_number(words[i]);
      if (!number) wrong(fmt::format("\"{}\" is not a number", excerpt(words[i])));
      header_.viewpoint[i] = *number;
    }
  }

  void take_data(const Words& words) {
    constexpr std::pair<std::string_view, PcdEncoding> kEncodings[] = {
        {"ascii", PcdEncoding::ascii},
        {"binary", PcdEncoding::binary},
        {"binary_compressed", PcdEncoding::compressed}};
    for (const auto& [name, encoding] : kEncodings) {
      if (words.empty() || words[0] != name) continue;
      header_.encoding = encoding;
      has_data_ = true;
      return;
    }
    wrong("DATA is neither ascii, binary nor binary_compressed");
  }

  void make_fields() {
    line_begin_ = 0;
    const std::size_t n = names_.size();
    if (n == 0 || n > kMostFields) wrong("the header has no FIELDS, or thousands of them");
    if (sizes_.size() != n || types_.size() != n || (!counts_.empty() && counts_.size() != n)) {
      wrong(
          fmt::format("FIELDS has {} columns, but SIZE, TYPE or COUNT have a different number", n));
    }
    for (std::size_t i = 0; i < n; ++i) {
      PcdField field{.name = std::string(names_[i])};
      const std::size_t size = parse_count(sizes_[i]).value_or(0);
      const std::optional<NumberType> type = number_type(types_[i], size);
      if (!type) {
        wrong(fmt::format("field \"{}\" has type \"{}\" of {} bytes", excerpt(names_[i]),
                          excerpt(types_[i]), size));
      }
      field.type = *type;
      field.count = counts_.empty() ? 1 : parse_count(counts_[i]).value_or(kLargestCount + 1);
      if (field.count > kLargestCount) {
        wrong(fmt::format("field \"{}\" has an invalid COUNT", excerpt(names_[i])));
      }
      field.offset = header_.point_size;
      header_.point_size += size * field.count;
      header_.fields.push_back(std::move(field));
    }
  }

  void make_size() {
    if (!width_ && !points_) wrong("neither WIDTH nor POINTS says how many points there are");
    header_.points = points_.value_or(0);
    header_.width = width_.value_or(header_.points);
    std::size_t grid = 0;
    const bool overflow = __builtin_mul_overflow(header_.width, header_.height, &grid);
    if (!points_) header_.points = grid;
    if (overflow || grid != header_.points) {
      wrong(fmt::format("WIDTH {} times HEIGHT {} is not POINTS {}", header_.width, header_.height,
                        header_.points));
    }
  }

  [[noreturn]] void wrong(std::string_view what) {
    fail_at_line(input_, line_begin_, what, "Correct the header, or export the file again as PCD");
  }

  const Input& input_;
  TextScanner scanner_;
  PcdHeader header_;
  Words names_;
  Words sizes_;
  Words types_;
  Words counts_;
  std::optional<std::size_t> width_;
  std::optional<std::size_t> points_;
  std::size_t line_begin_ = 0;
  bool has_data_ = false;
};

}  // namespace

PcdHeader read_pcd_header(const Input& input) {
  return PcdHeaderParser(input).run();
}

std::optional<std::size_t> lzf_unpack(std::span<const std::byte> packed,
                                      std::span<std::byte> unpacked) {
  std::size_t in = 0;
  std::size_t out = 0;
  while (in < packed.size()) {
    const std::size_t begin = in;
    const auto control = std::to_integer<std::size_t>(packed[in++]);
    if (control < 32) {
      const std::size_t run = control + 1;
      if (packed.size() - in < run || unpacked.size() - out < run) return begin;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), run,
                  unpacked.begin() + static_cast<std::ptrdiff_t>(out));
      in += run;
      out += run;
      continue;
    }
    std::size_t length = (control >> 5U) + 2;
    const std::size_t more = length == 9 ? 2 : 1;
    if (packed.size() - in < more) return begin;
    if (more == 2) length += std::to_integer<std::size_t>(packed[in++]);
    const std::size_t back =
        ((control & 31U) << 8U) + std::to_integer<std::size_t>(packed[in++]) + 1;
    if (back > out || unpacked.size() - out < length) return begin;
    // Byte by byte: the copy may overlap what it writes, and repeats it then.
    for (std::size_t i = 0; i < length; ++i, ++out) unpacked[out] = unpacked[out - back];
  }
  return out == unpacked.size() ? std::nullopt : std::optional{in};
}

}  // namespace palpate::io
