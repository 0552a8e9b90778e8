// Reports for people and programs.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/palpate/cli/output.hpp"

namespace palpate::app {

enum class Mark { plain, warning, error };

/// A part of a report. Each fact is given once: row() makes both the line for a person and the
/// datum for --json of it.
class Report {
 public:
  /// What a line begins with, ten letters at most; empty: it continues the line before.
  struct Label {
    // NOLINTNEXTLINE(google-explicit-constructor)
    Label(std::string of_line, Mark its_mark = Mark::plain)
        : text(std::move(of_line)), mark(its_mark) {}
    // NOLINTNEXTLINE(google-explicit-constructor)
    Label(const char* of_line, Mark its_mark = Mark::plain) : text(of_line), mark(its_mark) {}
    std::string text;
    Mark mark;
  };

  /// `title` stands out from `rest`.
  Report(std::string title, std::string rest) : title_(std::move(title)), rest_(std::move(rest)) {}

  /// A line: `pattern` with the values in it. {KEY} shows the next value, which is the datum KEY;
  /// '/' makes objects ("radius_m/median"). The key's unit ("_m", "_N_per_m", ...) sets how the
  /// value is shown. {} and a unit alone ({_m}) show a value that is no datum. Text in
  /// [brackets] is left out where its first value is 0, false, null or empty; what stands after |
  /// is shown instead: [{voxel_m}|none]. {?} takes a bool, which decides so and is not shown.
  /// A number that is not finite is null. A line without text is left out, its data are not.
  template <class... Value>
  void row(const Label& label, std::string_view pattern, const Value&... values) {
    write(data, label, pattern, {Json(values)...});
  }

  /// The same for the next element of the list `list`. Its first line alone shows the label.
  template <class... Value>
  void item(const char* list, const Label& label, std::string_view pattern,
            const Value&... values) {
    Json& items = list_at(list);
    const Label shown = items.empty() ? label : Label("", label.mark);
    write(items.emplace_back(), shown, pattern, {Json(values)...});
  }

  /// A line without data.
  void note(const Label& label, std::string text) { lines_.push_back({label, std::move(text)}); }

  /// Prints the lines that were added since the last call, after the title with the first one.
  void print(std::FILE* out);

  Json data = Json::object();  ///< SI units, named in the keys

 private:
  struct Line {
    Label label;
    std::string text;
  };

  [[nodiscard]] Json& list_at(const char* path);
  void write(Json& object, const Label& label, std::string_view pattern, std::vector<Json> values);

  std::string title_;
  std::string rest_;
  std::vector<Line> lines_;
  std::optional<std::size_t> printed_ = {};  // lines; unset: the title, neither
};

}  // namespace palpate::app
