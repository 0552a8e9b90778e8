// Recognises units of length by their names.
#include "io/units/length_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "io/input.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

struct LengthName {
  std::string_view name;  // small letters and digits alone
  double metres;
};

constexpr double kFoot = 0.3048;               // m (definition)
constexpr double kSurveyFoot = 1200 / 3937.0;  // m (definition)

// Plurals are without their s. The first name of each length names it in reports.
constexpr LengthName kLengthNames[] = {
    {"metre", 1},
    {"meter", 1},
    {"m", 1},
    {"mtr", 1},
    {"millimetre", 1e-3},
    {"millimeter", 1e-3},
    {"mm", 1e-3},
    {"centimetre", 1e-2},
    {"centimeter", 1e-2},
    {"cm", 1e-2},
    {"decimetre", 0.1},
    {"decimeter", 0.1},
    {"dm", 0.1},
    {"kilometre", 1e3},
    {"kilometer", 1e3},
    {"km", 1e3},
    {"micrometre", 1e-6},
    {"micrometer", 1e-6},
    {"micron", 1e-6},
    {"um", 1e-6},
    {"\xc2\xb5m", 1e-6},
    {"\xce\xbcm", 1e-6},
    {"nanometre", 1e-9},
    {"nanometer", 1e-9},
    {"nm", 1e-9},
    {"inch", 0.0254},
    {"inche", 0.0254},
    {"in", 0.0254},
    {"mil", 2.54e-5},
    {"thou", 2.54e-5},
    {"feet", kFoot},
    {"foot", kFoot},
    {"ft", kFoot},
    {"ifoot", kFoot},
    {"ift", kFoot},
    {"footinternational", kFoot},
    {"internationalfoot", kFoot},
    {"internationalfeet", kFoot},
    {"ftint", kFoot},
    {"footintl", kFoot},
    {"footus", kSurveyFoot},
    {"ussurveyfoot", kSurveyFoot},
    {"ussurveyfeet", kSurveyFoot},
    {"surveyfoot", kSurveyFoot},
    {"surveyfeet", kSurveyFoot},
    {"usfoot", kSurveyFoot},
    {"usfeet", kSurveyFoot},
    {"usft", kSurveyFoot},
    {"ussurveyft", kSurveyFoot},
    {"surveyft", kSurveyFoot},
    {"ftus", kSurveyFoot},
    {"sft", kSurveyFoot},
    {"usfootsurvey", kSurveyFoot},
    {"footussurvey", kSurveyFoot},
    {"ussft", kSurveyFoot},
    {"yard", 0.9144},
    {"yd", 0.9144},
    {"mile", 1609.344},
    {"statutemile", 1609.344},
};

std::string only_letters(std::string_view name) {
  std::string result = lower_case(name);
  std::erase_if(result, [](char c) {
    const auto letter = static_cast<unsigned char>(c);
    return letter < 0x80 && std::isalnum(letter) == 0;
  });
  return result;
}

// Words and numbers, small; an equals sign is a word, and a colon is one.
std::vector<std::string> words_in(std::string_view text) {
  std::vector<std::string> words;
  bool in_word = false;
  for (const char c : lower_case(text)) {
    const auto letter = static_cast<unsigned char>(c);
    const bool belongs = std::isalnum(letter) != 0 || letter >= 0x80 || c == '.' || c == '-';
    if (c == '=' || c == ':') words.emplace_back("=");
    if (belongs && !in_word) words.emplace_back();
    if (belongs) words.back() += c;
    in_word = belongs;
  }
  for (std::string& word : words) {
    while (word.size() > 1 && word.back() == '.') word.pop_back();
  }
  return words;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

// "in" is inches where nothing follows: "units: in", but not "unit 3 in block B".
bool is_inch(const std::vector<std::string>& words, std::size_t at) {
  return words[at] == "in" && at + 1 == words.size();
}

// A number, if there is one, and the name of a length: "1000 mm", "us survey foot".
std::optional<double> length_at(const std::vector<std::string>& words, std::size_t at) {
  constexpr std::size_t kLongestName = 3;  // words: US survey foot
  if (at >= words.size()) return {};
  const std::optional<double> number = parse_number(words[at]);
  if (number && !(*number > 0 && std::isfinite(*number))) return {};
  if (number) ++at;
  std::string name;
  std::optional<double> metres;
  for (std::size_t k = at; k < std::min(at + kLongestName, words.size()); ++k) {
    name += words[k];
    if (name == "in" && !is_inch(words, k)) break;
    if (const auto longer = metres_of(name)) metres = longer;
  }
  if (!metres) return {};
  return number.value_or(1) * *metres;
}

// A unit that its word at `unit` does not lead to: "centimeters as units for coordinates",
// "units for the vertices of this model: meters".
std::optional<double> length_far_from(const std::vector<std::string>& words, std::size_t unit) {
  if (unit > 1 && words[unit - 1] == "as") return metres_of(words[unit - 2]);
  const auto from = words.begin() + static_cast<std::ptrdiff_t>(unit);
  const auto mark = std::find(from, words.end(), "=");
  const std::size_t at = static_cast<std::size_t>(mark - words.begin()) + 1;
  if (at >= words.size() || parse_number(words[at])) return {};
  return length_at(words, at);
}

}  // namespace

std::optional<double> metres_of(std::string_view name) {
  if (trim(name) == "\"") return metres_of("inch");
  std::string plain = only_letters(name);
  const auto find = [&] { return std::ranges::find(kLengthNames, plain, &LengthName::name); };
  if (const auto* found = find(); found != std::end(kLengthNames)) return found->metres;
  constexpr std::size_t kShortestPlural = 3;  // letters: "ms" are milliseconds
  if (plain.size() < kShortestPlural || !plain.ends_with('s')) return {};
  plain.pop_back();
  const auto* found = find();
  if (found == std::end(kLengthNames)) return {};
  return found->metres;
}

bool is_unit_of_length(double metres) {
  return metres >= 1e-9 && metres <= 1e9;
}

bool is_same_unit(double metres, double other) {
  constexpr double kSame = 1e-5;  // share
  return std::abs(metres / other - 1) < kSame;
}

std::string name_of_length(double metres) {
  const auto* found = std::ranges::find_if(
      kLengthNames, [&](const LengthName& each) { return is_same_unit(metres, each.metres); });
  if (found == std::end(kLengthNames)) return fmt::format("units of {:.4g} m", metres);
  std::string name(found->name);
  if (name == "feet") return name;
  return name + (name == "inch" ? "es" : "s");
}

std::optional<double> unit_in_sentence(std::string_view text) {
  const std::vector<std::string> words = words_in(text);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool unit = is_one_of(words[i], {"unit", "units", "unitname", "lengthunit"});
    if (!unit && !is_one_of(words[i], {"coordinates", "lengths", "dimensions", "vertices", "values",
                                       "measurements", "distances", "points", "data"})) {
      continue;
    }
    std::size_t at = i + 1;
    while (at < words.size() && !is_inch(words, at) &&
           is_one_of(words[at], {"=", "is", "are", "in", "of", "the", "length", "equals", "system",
                                 "type", "name", "for", "coordinates", "vertices", "to"})) {
      ++at;
    }
    if (!unit && (at == i + 1 || words[at - 1] != "in")) continue;        // "points in mm"
    if (!unit && at < words.size() && parse_number(words[at])) continue;  // "points in 2 m around"
    std::optional<double> length = length_at(words, at);
    if (!length && unit) length = length_far_from(words, i);
    if (!length) continue;
    const double before = unit && i > 0 ? parse_number(words[i - 1]).value_or(1) : 1;
    const double metres = *length / (before > 0 ? before : 1);
    if (is_unit_of_length(metres)) return metres;
  }
  return {};
}

namespace {

// "ft", "US survey feet", "NAVD88 ft": as many of the last words as name a unit.
std::optional<double> unit_at_end(std::string_view words) {
  for (words = trim(words); !words.empty();) {
    if (const auto metres = metres_of(words)) return metres;
    words.remove_prefix(std::min(words.find(' '), words.size()));
    words = trim(words);
  }
  return {};
}

}  // namespace

std::optional<double> unit_behind_name(std::string_view name) {
  name = trim(name);
  const std::size_t open = name.find_first_of("[({");
  if (open != std::string_view::npos) {
    name.remove_prefix(open + 1);
    return unit_at_end(name.substr(0, name.find_first_of("])}")));
  }
  const std::size_t mark = name.find_last_of("_/ ");
  if (mark == std::string_view::npos) return {};
  return metres_of(name.substr(mark + 1));
}

}  // namespace palpate::io
