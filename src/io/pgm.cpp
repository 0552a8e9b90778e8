#include "io/pgm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "io/number.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// The three numbers of the header are separated by white space and comments up to the line's end;
// exactly one white-space character follows the last.
class PgmHeaderParser {
 public:
  explicit PgmHeaderParser(const Input& input)
      : input_(input), offset_(std::min<std::size_t>(2, input.bytes.size())) {}

  std::size_t number(std::string_view what) {
    const std::string_view text = input_.text();
    while (offset_ < text.size() && (is_space(text[offset_]) || text[offset_] == '#')) {
      if (text[offset_] == '#') offset_ = std::min(text.find('\n', offset_), text.size() - 1);
      ++offset_;
    }
    const std::size_t begin = offset_;
    while (offset_ < text.size() && text[offset_] >= '0' && text[offset_] <= '9') ++offset_;
    const std::optional<std::size_t> value = parse_count(text.substr(begin, offset_ - begin));
    if (!value) {
      fail_at_byte(input_, begin, fmt::format("the PGM header lacks its {}", what),
                   "Fetch or export the image again");
    }
    return *value;
  }

  [[nodiscard]] std::size_t data_offset() const { return offset_ + 1; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  const Input& input_;
  std::size_t offset_;  // at first behind "P5"
};

}  // namespace

DepthImage read_pgm(const Input& input) {
  PgmHeaderParser header(input);
  DepthImage image;
  image.width = header.number("width");
  image.height = header.number("height");
  const std::size_t largest = header.number("largest value");
  if (largest < 256 || largest > 65535) {
    fail(input, fmt::format("a PGM picture of values up to {}, not a 16-bit depth image", largest),
         "Give the depth image of the camera, or a point cloud");
  }
  check_image_size(input, image.width, image.height);
  image.largest = static_cast<std::uint16_t>(largest);
  image.format = fmt::format("depth PGM, {} x {}", image.width, image.height);
  const std::size_t begin = std::min(header.data_offset(), input.bytes.size());
  const std::size_t pixels = image.width * image.height;
  const std::size_t present = (input.bytes.size() - begin) / 2;
  if (present < pixels) {
    fail_at_byte(input, input.bytes.size(),
                 fmt::format("the file ends after {} of {} pixels", present, pixels),
                 "Fetch the image again");
  }
  image.samples.reserve(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    image.samples.push_back(
        load_as<std::uint16_t>(input.bytes.data() + begin + 2 * i, std::endian::big));
  }
  return image;
}

}  // namespace palpate::io
