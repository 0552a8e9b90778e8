#include "sensor/frame_list.hpp"

#include <cmath>
#include <optional>
#include <span>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::sensor {
namespace {

constexpr std::string_view kRemedy = "Correct this line, or write the list again";

std::optional<ListedFrame> take_frame(std::string_view& line) {
  const std::optional<double> stamp = io::parse_number(io::take_word(line));
  const std::string_view image = io::take_word(line);
  if (!stamp || !std::isfinite(*stamp) || image.empty()) return {};
  return ListedFrame{*stamp, std::string(image)};
}

bool is_depth(const ListedFrame& frame) {
  return frame.image.find("depth") != std::string::npos;
}

// The frame of a line; of two, the one of depth.
std::optional<ListedFrame> frame_of(std::string_view line) {
  std::optional<ListedFrame> first = take_frame(line);
  if (!first || io::trim(line).empty()) return first;
  std::optional<ListedFrame> second = take_frame(line);
  if (!second || !io::trim(line).empty() || is_depth(*first) == is_depth(*second)) return {};
  return is_depth(*first) ? first : second;
}

}  // namespace

std::vector<ListedFrame> parse_frame_list(std::string_view text, const std::string& name) {
  const ReadOptions unused;
  const io::Input input{std::as_bytes(std::span(text)), name, unused};
  std::vector<ListedFrame> frames;
  io::TextScanner scanner(input);
  while (!scanner.at_end()) {
    const std::size_t offset = scanner.offset();
    const std::string_view line = io::trim(scanner.next_line());
    if (line.empty() || line.front() == '#') continue;
    std::optional<ListedFrame> frame = frame_of(line);
    if (!frame) {
      io::fail_at_line(input, offset,
                       "this is neither \"time file\" nor \"time file time file\" with one of the "
                       "files under depth/",
                       kRemedy);
    }
    if (!frames.empty() && frame->stamp <= frames.back().stamp) {
      io::fail_at_line(input, offset, "this time is not after that of the line before", kRemedy);
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace palpate::sensor
