// Decides on the unit of a file: what the caller gave, what the file states, what is likely.
#include "io/units/file_unit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/text_scanner.hpp"
#include "io/units/length_names.hpp"

namespace palpate::io {
namespace {

// Programs that write what was scanned or surveyed in metres alone, in small letters.
constexpr std::string_view kInMetres[] = {"scaniverse", "polycam",  "record3d",    "sitescape",
                                          "3d scanner", "scandy",   "matterport",  "arkit",
                                          "arcore",     "rtab-map", "opendronemap"};

// What the words for a unit end with where a file states that of heights alone.
constexpr std::string_view kNoPlan = " for heights alone";

double farthest(const Box& box) {
  return std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
}

// The lines of a text that begin with a mark, and what they state.
class Comments {
 public:
  explicit Comments(std::string_view mark) : mark_(mark) {}

  void look_at(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with(mark_)) return;
    ++count_;
    if (const auto metres = unit_in_sentence(line)) {
      keep({.plan = metres}, fmt::format("\"{}\"", excerpt(trim(line))));
    } else if (const std::string small = lower_case(line); !by_) {
      const auto* name = std::ranges::find_if(
          kInMetres, [&](std::string_view each) { return small.find(each) != std::string::npos; });
      if (name == std::end(kInMetres)) return;
      by_ = fmt::format("\"{}\", which means metres", excerpt(trim(line)));
    }
  }

  [[nodiscard]] bool goes_on() const {
    constexpr std::size_t kMost = 1000;  // lines of a header, by far (judgement)
    return count_ < kMost && !stated_.plan;
  }

  [[nodiscard]] Input applied_to(const Input& input) const {
    if (stated_.plan) return in_stated_unit(input, stated_, words_);
    return by_ ? in_stated_unit(input, {.plan = 1}, *by_) : input;
  }

 private:
  void keep(const StatedUnits& stated, std::string words) {
    stated_ = stated;
    stated_.height = stated.plan;
    words_ = std::move(words);
  }

  std::string_view mark_;
  std::size_t count_ = 0;
  StatedUnits stated_;
  std::string words_;
  std::optional<std::string> by_;
};

}  // namespace

namespace {

void check_unit(const Input& input, const FileUnit& unit) {
  for (const double metres : {unit.plan, unit.height}) {
    if (is_unit_of_length(metres)) continue;
    fail(input, fmt::format("it states by {} a unit of {:g} m, which is none", unit.words, metres),
         "Give the metres a unit, for example a scale of 1");
  }
}

}  // namespace

Input in_stated_unit(Input input, const StatedUnits& stated, std::string words) {
  if (!stated.plan && !stated.height) return input;
  const double plan = stated.plan.value_or(stated.assumed);
  if (!stated.plan) words += kNoPlan;
  FileUnit unit{.plan = plan,
                .height = stated.height.value_or(plan),
                .source = FileUnit::Source::stated,
                .height_stated = stated.height.has_value(),
                .words = std::move(words)};
  const FileUnit& given = input.unit;
  if (given.source != FileUnit::Source::given) {
    check_unit(input, unit);
    input.unit = std::move(unit);
  } else if ((stated.plan && !is_same_unit(unit.plan, given.plan)) ||
             (unit.height_stated && !is_same_unit(unit.height, given.height))) {
    input.unit.words =
        fmt::format("the file says that it is{}, by {}", words_of(unit).substr(1), unit.words);
  }
  return input;
}

Input in_unit_of_comments(const Input& input, std::string_view text, std::string_view mark) {
  Comments comments(mark);
  std::size_t at = text.find(mark);  // marks are sought, since faces may be millions of lines
  while (at < text.size() && comments.goes_on()) {
    const std::size_t begin = text.find_last_of("\r\n", at) + 1;  // npos + 1 is 0
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    comments.look_at(text.substr(begin, end - begin));
    at = end < text.size() ? text.find(mark, end + 1) : text.size();
  }
  return comments.applied_to(input);
}

bool is_survey(const Box& box) {
  constexpr double kFar = 5e4;  // units: no machine is 50 m of millimetres from its origin
  return farthest(box) > kFar && box.size().maxCoeff() < 0.5 * box.upper.cwiseAbs().maxCoeff();
}

FileUnit likely_unit(const Box& box) {
  constexpr double kShortest = 1;    // mm: nothing shorter is drawn as a part (judgement)
  constexpr double kLongest = 2000;  // mm: no longer part is printed or cut in one (judgement)
  const double length = box.size().maxCoeff();
  const char* why = "those who draw parts of 1 to 2000 draw in millimetres";
  double metres = 1e-3;
  if (is_survey(box)) {
    why = "it is as far from the origin as surveys are";
    metres = 1;
  } else if (length < kShortest) {
    why = "parts in millimetres are longer";
    metres = 1;
  } else if (length > kLongest) {
    why = "parts in millimetres are shorter";
    metres = 1;
  }
  return {.plan = metres,
          .height = metres,
          .source = FileUnit::Source::likely,
          .words = fmt::format("the longest side is {:.4g}, the file states no unit, and {}",
                               length, why)};
}

bool states_heights_alone(const FileUnit& unit) {
  return unit.source == FileUnit::Source::stated && unit.words.ends_with(kNoPlan);
}

double other_plan(const FileUnit& unit) {
  if (!is_same_unit(unit.plan, 1)) return 1;
  return is_same_unit(unit.height, 1) ? 0.3048 : unit.height;  // feet, in which surveys are
}

std::string words_of(const FileUnit& unit) {
  const std::string name = name_of_length(unit.plan);
  if (unit.source == FileUnit::Source::likely) return ", taken as " + name;
  if (unit.source != FileUnit::Source::stated) return {};
  if (is_same_unit(unit.plan, unit.height)) return ", in " + name;
  return fmt::format(", in {}, heights in {}", name, name_of_length(unit.height));
}

}  // namespace palpate::io
