// Reads trajectories from CSV.
#include "palpate/io/trajectory.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/turn.hpp"
#include "io/held_columns.hpp"
#include "io/table.hpp"
#include "io/text_scanner.hpp"
#include "io/time_unit.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

namespace {

// First what every trajectory has, then what a measured force and an opening take.
constexpr std::array<std::string_view, 8> kColumns = {"t",  "hip_x", "hip_y", "hip_z",
                                                      "fx", "fy",    "fz",    "gripper"};
constexpr std::size_t kNeeded = 4;
constexpr std::size_t kOpening = 7;

std::vector<std::string_view> split(std::string_view line, std::string_view separator) {
  std::vector<std::string_view> cells;
  while (const auto cell = io::take_cell(line, separator)) cells.push_back(*cell);
  return cells;
}

// Values between blanks, commas and semicolons, up to a comment.
std::vector<std::string_view> split_loosely(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r,;";
  line = line.substr(0, line.find_first_of("#%"));
  std::vector<std::string_view> cells;
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(kBetween, at);
    cells.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBetween, std::min(end, line.size()));
  }
  return cells;
}

bool is_text(std::string_view line) {
  return std::ranges::none_of(line,
                              [](char c) { return c >= 0 && c < ' ' && c != '\t' && c != '\r'; });
}

std::string_view separator_of(std::string_view header) {
  for (const std::string_view candidate : {",", ";", "\t"}) {
    if (header.find(candidate) != std::string_view::npos) return candidate;
  }
  return ",";
}

std::optional<double> number(std::string_view text) {
  const std::optional<double> value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

class Reader {
 public:
  Reader(std::string name, const TrajectoryOptions& options)
      : name_(std::move(name)), options_(options) {}

  Trajectory read(std::istream& stream) {
    if (named()) take_columns({options_.columns.begin(), options_.columns.end()});
    std::string line;
    while (std::getline(stream, line)) {
      ++line_;
      if (line_ == 1 && io::is_utf16(line)) fail("this is UTF-16 text. Save it as UTF-8");
      if (line_ == 1 && line.starts_with(io::kByteOrderMark)) {
        line.erase(0, io::kByteOrderMark.size());
      }
      take_line(line);
    }
    if (stream.bad()) fail("could not be read completely");
    if (!begun_) fail("is empty: the first line must name the columns t,hip_x,hip_y,hip_z");
    if (rows_.empty()) fail("has no rows: give at least one step");
    return std::move(rows_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    if (line_ == 0) throw Error(fmt::format("{}: {}", name_, what));
    throw Error(fmt::format("{}, line {}: {}", name_, line_, what));
  }

  [[nodiscard]] bool named() const { return !options_.columns.empty(); }

  void take_line(std::string_view line) {
    if (named()) {
      if (!is_text(line)) fail("this is not text; convert it to columns first");
      const std::vector<std::string_view> cells = split_loosely(line);
      if (!cells.empty()) row(cells);
      return;
    }
    const std::string_view text = io::trim(line);
    if (text.empty() || text.front() == '#') return;
    if (!begun_) {
      separator_ = separator_of(text);
      take_columns(split(text, separator_));
    } else {
      row(split(line, separator_));
    }
  }

  void take_columns(const std::vector<std::string_view>& names) {
    begun_ = true;
    for (std::size_t wanted = 0; wanted < kColumns.size(); ++wanted) {
      const auto found = std::ranges::find(names, kColumns[wanted]);
      if (found != names.end()) {
        slots_[wanted] = static_cast<std::size_t>(found - names.begin());
      } else if (wanted < kNeeded) {
        fail(fmt::format("no column '{}': {} must name t,hip_x,hip_y,hip_z (it reads '{}')",
                         kColumns[wanted], named() ? "the list of columns" : "the header line",
                         fmt::format("{}", fmt::join(names, ",")).substr(0, 80)));
      }
    }
    if (!options_.forces || count(kNeeded, kOpening) < kOpening - kNeeded) {
      std::fill(slots_.begin() + kNeeded, slots_.begin() + kOpening, std::nullopt);
    }
    const io::FoundColumns found = io::find_held_columns(names);
    if (!found.problem.empty()) fail(found.problem);
    held_ = found.columns;
    for (const std::string_view name : names) names_.emplace_back(name);
    if (held_ && options_.remark && !held_->words.empty()) options_.remark(held_->words);
  }

  [[nodiscard]] std::size_t count(std::size_t begin, std::size_t end) const {
    return static_cast<std::size_t>(std::count_if(
        slots_.begin() + static_cast<std::ptrdiff_t>(begin),
        slots_.begin() + static_cast<std::ptrdiff_t>(end), [](const auto& slot) { return slot; }));
  }

  void row(const std::vector<std::string_view>& cells) {
    if (named() && cells.size() != options_.columns.size()) {
      fail(fmt::format("{} values, but {} columns are named", cells.size(),
                       options_.columns.size()));
    }
    std::array<double, kColumns.size()> values{};
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i]) values[i] = value(cells, *slots_[i]);
    }
    if (const auto wrong = io::not_in_seconds(values[0])) {
      fail(fmt::format("{}. {}.", wrong->what, wrong->remedy));
    }
    if (!rows_.empty() && !(values[0] > rows_.back().time)) {
      fail(fmt::format("t = {} s follows t = {} s: times must increase from row to row", values[0],
                       rows_.back().time));
    }
    TrajectoryRow& added = rows_.emplace_back();
    added.time = values[0];
    added.position = {values[1], values[2], values[3]};
    if (slots_[kNeeded]) added.force = {values[4], values[5], values[6]};
    if (slots_[kOpening]) added.opening = values[kOpening];
    if (held_) added.orientation = orientation(cells);
  }

  Eigen::Quaterniond orientation(const std::vector<std::string_view>& cells) const {
    constexpr double kTurn = 6.3;  // rad, and a little
    std::array<double, 4> numbers{};
    std::size_t k = 0;
    for (const std::size_t slot : held_->used()) {
      numbers[k] = value(cells, slot);
      if (held_->angles && !held_->stated && std::abs(numbers[k]) > kTurn) {
        fail(
            fmt::format("{} = {} is more than a turn in radians: write roll_deg,pitch_deg,yaw_deg "
                        "in the header line if it is degrees, else roll_rad,pitch_rad,yaw_rad",
                        names_[slot].substr(0, 40), numbers[k]));
      }
      ++k;
    }
    const Eigen::Quaterniond result = held_->orientation(numbers);
    if (!is_about_unit(result)) {
      fail(fmt::format("{} is no quaternion of unit length",
                       held_->words.empty() ? "qx,qy,qz,qw" : held_->words));
    }
    return result;
  }

  [[nodiscard]] double value(const std::vector<std::string_view>& cells, std::size_t slot) const {
    if (slot >= cells.size()) {
      fail(fmt::format("the row ends before column '{}'; a row of this file has at least {} values",
                       names_[slot].substr(0, 40), slot + 1));
    }
    const std::optional<double> found = number(cells[slot]);
    if (!found) {
      fail(fmt::format("'{}' in column '{}' is not a finite number: correct or remove the row",
                       cells[slot].substr(0, 40), names_[slot].substr(0, 40)));
    }
    return *found;
  }

  std::string name_;
  std::size_t line_ = 0;
  const TrajectoryOptions& options_;
  std::string_view separator_ = ",";
  bool begun_ = false;                                             // the columns are known
  std::array<std::optional<std::size_t>, kColumns.size()> slots_;  // of kColumns, in a row
  std::vector<std::string> names_;                                 // of all columns
  std::optional<io::HeldColumns> held_;
  Trajectory rows_;
};

}  // namespace

Trajectory read_trajectory(std::istream& stream, const std::string& name,
                           const TrajectoryOptions& options) {
  return Reader(name, options).read(stream);
}

Trajectory read_trajectory(const std::filesystem::path& path, const TrajectoryOptions& options) {
  if (path == "-") return read_trajectory(std::cin, "standard input", options);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(fmt::format("{} is a folder: give the CSV file of a trajectory", path.string()));
  }
  std::ifstream stream(path);
  if (!stream) {
    throw Error(
        fmt::format("{} cannot be opened: check the path and its permissions", path.string()));
  }
  return read_trajectory(stream, path.string(), options);
}

}  // namespace palpate
