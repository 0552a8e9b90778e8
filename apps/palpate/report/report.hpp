#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"

namespace palpate::app {

/// Of a cloud that is on_a_line().
inline constexpr const char* kNoSurface =
    "all points are at one place or on a line, where no surface is";

enum class Mark { plain, warning, error };

/// A part of a report: lines for a person, and the same facts as data.
class Report {
 public:
  /// `title` stands out from `rest`.
  Report(std::string title, std::string rest) : title_(std::move(title)), rest_(std::move(rest)) {}

  /// One below the title. `label`: ten letters at most; empty: it goes on from the line before.
  void line(const std::string& label, std::string text, Mark mark = Mark::plain) {
    lines_.push_back({label, std::move(text), mark});
  }

  void print(std::FILE* out) const;

  Json data = Json::object();  ///< SI units, named in the keys

 private:
  struct Line {
    std::string label;
    std::string text;
    Mark mark;
  };

  std::string title_;
  std::string rest_;
  std::vector<Line> lines_;
};

/// ", 12 invalid"; empty where there are none.
[[nodiscard]] std::string and_some(std::size_t count, const char* words);

/// JSON has no infinity: null is no limit.
[[nodiscard]] Json limit(double value);

/// What a run knows of one of its sources and, of a camera, of what became of its frames.
[[nodiscard]] Report source_report(const LoadedSource& source);

/// That of a camera.
[[nodiscard]] Report camera_report(const LoadedSource& source);

/// Says how much of a cloud is no surface that its points agree on, where it is a hundredth or
/// more.
void add_trust(Report& report, const Prepared::Report& prepared);

/// "640 x 480 pixels of a camera of 525 px".
[[nodiscard]] std::string in_words(const CameraModel& camera);

/// The same as data.
[[nodiscard]] Json json_of(const CameraModel& camera);

}  // namespace palpate::app
