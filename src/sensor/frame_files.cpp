// Finds the depth images or clouds of a folder and puts them in order.
#include "sensor/frame_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/input.hpp"
#include "palpate/base/error.hpp"
#include "sensor/sequence.hpp"

namespace palpate::sensor {
namespace {

namespace fs = std::filesystem;

bool is_frame(const fs::path& path) {
  const std::string ending = io::extension(path.string());
  return ending == ".png" || ending == ".pgm" || is_cloud(path);
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Takes the digits that a text begins with.
std::string_view take_digits(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, is_digit);
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  return digits;
}

// Below 0: the whole number `a` is less than `b`, whatever their leading zeros and lengths.
int compare_numbers(std::string_view a, std::string_view b) {
  a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
  b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

// Orders names by the numbers in them: "f2" comes before "f10". Digits behind a number and a point
// are a fraction, which its first digits order, so that "1.25" comes before "1.5".
bool comes_before(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  bool counted = false;   // a number ends here
  bool fraction = false;  // a fraction begins here
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view first = take_digits(a);
      const std::string_view second = take_digits(b);
      const int order = fraction ? first.compare(second) : compare_numbers(first, second);
      if (order != 0) return order < 0;
      counted = !fraction;
      fraction = false;
      continue;
    }
    if (a.front() != b.front()) return a.front() < b.front();
    fraction = counted && a.front() == '.';
    counted = false;
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  return a.empty() == b.empty() ? whole_a < whole_b : a.empty();
}

bool names_depth(const fs::path& image) {
  return image.filename().string().find("depth") != std::string::npos;
}

// Where names distinguish depth images from the colour images beside them ("frame-000000.depth.png"
// and "frame-000000.color.png" of 7-Scenes), those of depth alone are frames.
void drop_other_pictures(std::vector<fs::path>& images) {
  if (std::ranges::none_of(images, names_depth)) return;
  std::erase_if(images, [](const fs::path& image) { return !names_depth(image); });
}

}  // namespace

std::vector<fs::path> frames_in(const fs::path& folder, const std::string& wanted) {
  std::error_code failure;
  const bool usual = wanted.empty() && fs::is_directory(folder / "depth", failure);
  const fs::path listed = usual ? folder / "depth" : folder / wanted;
  std::vector<fs::path> frames;
  fs::directory_iterator entry(listed, failure);
  for (; !failure && entry != fs::directory_iterator(); entry.increment(failure)) {
    if (is_frame(entry->path())) frames.push_back(entry->path());
  }
  if (failure) {
    throw Error(
        fmt::format("{}: cannot be listed ({}). Give the folder of the depth images "
                    "(\"images\" in sequence.json).",
                    listed.string(), failure.message()));
  }
  std::ranges::sort(frames, [](const fs::path& a, const fs::path& b) {
    return comes_before(a.filename().string(), b.filename().string());
  });
  if (std::ranges::all_of(frames, is_cloud)) return frames;
  std::erase_if(frames, is_cloud);  // what somebody made of the images
  drop_other_pictures(frames);
  return frames;
}

}  // namespace palpate::sensor
