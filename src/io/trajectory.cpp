// Reads trajectories from CSV.
#include "palpate/io/trajectory.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <optional>
#include <string_view>
#include <vector>

#include "io/text_scanner.hpp"
#include "palpate/base/error.hpp"

namespace palpate {

namespace {

constexpr std::array<std::string_view, 4> kColumns = {"t", "hip_x", "hip_y", "hip_z"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\"";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view header) {
  for (const char candidate : {',', ';', '\t'}) {
    if (header.find(candidate) != std::string_view::npos) return candidate;
  }
  return ',';
}

std::optional<double> number(std::string_view text) {
  const std::optional<double> value = io::parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// Position of each of kColumns in the header.
using Columns = std::array<std::size_t, kColumns.size()>;

class Reader {
 public:
  explicit Reader(std::string name) : name_(std::move(name)) {}

  Trajectory read(std::istream& stream) {
    std::string line;
    while (std::getline(stream, line)) {
      ++line_;
      if (line_ == 1 && io::is_utf16(line)) fail("this is UTF-16 text. Save it as UTF-8");
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
      const std::string_view text = trimmed(line);
      if (text.empty() || text.front() == '#') continue;
      if (!columns_) {
        header(text);
      } else {
        row(line);
      }
    }
    if (stream.bad()) fail("could not be read completely");
    if (!columns_) fail("is empty: the first line must name the columns t,hip_x,hip_y,hip_z");
    if (rows_.empty()) fail("has a header but no rows: give at least one step");
    return std::move(rows_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}, line {}: {}", name_, line_, what));
  }

  void header(std::string_view text) {
    separator_ = separator_of(text);
    const std::vector<std::string_view> names = split(text, separator_);
    Columns columns{};
    for (std::size_t wanted = 0; wanted < kColumns.size(); ++wanted) {
      std::size_t found = 0;
      while (found < names.size() && names[found] != kColumns[wanted]) ++found;
      if (found == names.size()) {
        fail(fmt::format(
            "no column '{}': the header line must name t,hip_x,hip_y,hip_z (it reads '{}')",
            kColumns[wanted], text.substr(0, 80)));
      }
      columns[wanted] = found;
    }
    columns_ = columns;
  }

  void row(std::string_view line) {
    const std::vector<std::string_view> cells = split(line, separator_);
    std::array<double, kColumns.size()> values{};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const std::size_t place = (*columns_)[i];
      if (place >= cells.size()) {
        fail(fmt::format(
            "the row ends before column '{}'; a row of this file has at least {} values",
            kColumns[i], place + 1));
      }
      const std::optional<double> value = number(cells[place]);
      if (!value) {
        fail(fmt::format("'{}' in column '{}' is not a finite number: correct or remove the row",
                         cells[place].substr(0, 40), kColumns[i]));
      }
      values[i] = *value;
    }
    if (!rows_.empty() && !(values[0] > rows_.back().time)) {
      fail(fmt::format("t = {} s follows t = {} s: times must increase from row to row", values[0],
                       rows_.back().time));
    }
    rows_.push_back({values[0], {values[1], values[2], values[3]}});
  }

  std::string name_;
  std::size_t line_ = 0;
  char separator_ = ',';
  std::optional<Columns> columns_;
  Trajectory rows_;
};

}  // namespace

Trajectory read_trajectory(std::istream& stream, const std::string& name) {
  return Reader(name).read(stream);
}

Trajectory read_trajectory(const std::filesystem::path& path) {
  if (path == "-") return read_trajectory(std::cin, "standard input");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(fmt::format("{} is a folder: give the CSV file of a trajectory", path.string()));
  }
  std::ifstream stream(path);
  if (!stream) {
    throw Error(
        fmt::format("{} cannot be opened: check the path and its permissions", path.string()));
  }
  return read_trajectory(stream, path.string());
}

}  // namespace palpate
