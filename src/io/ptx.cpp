// Reads the scans of PTX files: grids of points, each with its scanner's pose.
#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "io/cloud_builder.hpp"
#include "io/formats.hpp"
#include "io/input.hpp"
#include "io/table.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

// Values in the lines before a scan's points: columns, rows, the scanner's position and axes, and
// the matrix that leads from its frame to the world.
constexpr std::array<std::size_t, 10> kPtxHead{1, 1, 3, 3, 3, 3, 4, 4, 4, 4};
constexpr std::size_t kMatrixBegin = 6;  // lines before those of the matrix

// Values of a point: x y z intensity, and red green blue.
constexpr std::size_t kPlain = 4;
constexpr std::size_t kColored = 7;
constexpr std::array<std::optional<std::size_t>, kColored> kInOrder{0, 1, 2, 3, 4, 5, 6};

// Do numbers end a matrix of a motion, as 0 0 0 1 does? Text of few digits may miss it a little.
bool are_last(const Eigen::RowVector4d& numbers) {
  constexpr double kRounding = 1e-6;  // of six digits behind the point (derived)
  return (numbers - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kRounding;
}

class PtxReader {
 public:
  PtxReader(const Input& input, bool by_columns)
      : input_(input),
        rows_(input, 0),
        progress_(input.options, input.bytes.size()),
        by_columns_(by_columns) {}

  // Nothing where matrices are by columns, and are not read so.
  std::optional<CloudFile> run() {
    std::size_t scans = 0;
    for (bool there = rows_.next(); there; ++scans) {
      if (!read_head()) return {};
      there = read_points();
    }
    if (!builder_) fail(input_, "this PTX file holds no points", "Export it again");
    CloudFile file = builder_->finish(format());
    if (counts_.uncolored > 0) file.cloud.colors.clear();
    const Eigen::Vector3d stand = input_.scale().cwiseProduct(matrix_.row(3).head<3>().transpose());
    if (scans == 1 && is_usable(stand)) file.cloud.viewpoint = stand;
    return file;
  }

 private:
  using Values = std::array<double, kColored>;

  // Points of all scans.
  struct Counts {
    std::size_t unseen = 0;  // before the first that is seen
    std::size_t uncolored = 0;
    std::size_t colored = 0;
    double missing = 0;  // that are declared and not there
  };

  // False: the matrix is by columns, and those before it, whose shift may be 0, were read by rows.
  bool read_head() {
    begin_ = rows_.begin();
    std::array<double, 2> size{};
    for (std::size_t line = 0; line < kPtxHead.size(); ++line) {
      Values values{};
      const bool there = line == 0 || rows_.next();
      if (!there || !rows_.read(std::span(kInOrder).first(kPtxHead[line]), values)) {
        fail_at_line(input_, begin_, "the file ends within the header of the scan that begins here",
                     kAgain);
      }
      if (line < size.size()) size[line] = values[0];
      if (line < kMatrixBegin) continue;
      matrix_.row(static_cast<int>(line - kMatrixBegin)) = Eigen::RowVector4d::Map(values.data());
    }
    if (!(size[0] >= 0 && size[1] >= 0)) {
      fail_at_line(input_, begin_,
                   fmt::format("a scan of {} columns and {} rows", size[0], size[1]),
                   "Correct these numbers, or export the file again");
    }
    points_ = size[0] * size[1];
    return turn_matrix();
  }

  // Its shift is in the last row; in the last column where a program wrote it by columns.
  bool turn_matrix() {
    const bool by_rows = are_last(matrix_.col(3).transpose());
    const bool by_columns = are_last(matrix_.row(3));
    if (!by_rows && by_columns && !by_columns_) return false;
    if (by_columns_ ? by_columns : by_rows) {
      if (by_columns_) matrix_.transposeInPlace();
      return true;
    }
    fail_at_line(input_, begin_,
                 by_rows ? "the matrix of the scan that begins here is written by rows, those of "
                           "others by columns"
                         : "the matrix of the scan that begins here is no motion, which has 0, 0, "
                           "0 and 1 at the ends of its four lines",
                 "Correct it, or export the file again");
  }

  // Is there a row after them? Programs that leave out where nothing came back begin the next scan
  // early. What a file of less than 2^53 bytes can hold is counted exactly.
  bool read_points() {
    width_ = 0;
    for (double i = 0; i < points_; ++i) {
      if (!rows_.next()) fail_cut(i, "");
      Values values{};
      const std::size_t count = read_values(values);
      const bool seen = !(values[0] == 0 && values[1] == 0 && values[2] == 0);
      if (count == 1 && i > 0 && rows_.offset() < input_.bytes.size()) {
        counts_.missing += points_ - i;
        return true;
      }
      if (seen && width_ == 0) width_ = count;
      if ((count != kPlain && count != kColored) || (seen && count != width_)) fail_width(i, count);
      add(values, count, seen);
    }
    return rows_.next();
  }

  std::size_t read_values(Values& values) const {
    std::size_t count = 0;
    std::string_view rest = rows_.line();
    for (; const auto cell = take_cell(rest, " "); ++count) {
      if (count == kColored) return count + 1;
      const std::optional<double> number = parse_cell(*cell, '.');
      if (!number) {
        fail_at_line(input_, rows_.begin(), fmt::format("\"{}\" is not a number", excerpt(*cell)),
                     "Correct this line, or export the file again");
      }
      values[count] = *number;
    }
    return count;
  }

  // A scanner writes zeros where nothing came back. The first point that is seen shows whether
  // there are colours.
  void add(const Values& values, std::size_t count, bool seen) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (!builder_ && !seen) {
      ++counts_.unseen;
      return;
    }
    if (!builder_) {
      // A value takes a digit and a space.
      const std::size_t room = (input_.bytes.size() - rows_.begin()) / (2 * count) + 1;
      const Columns columns{.colors = count == kColored, .intensities = true};
      builder_.emplace(input_, columns, ColorScale::byte, room + counts_.unseen);
      for (std::size_t i = 0; i < counts_.unseen; ++i) builder_->add({kNone, kNone, kNone});
    }
    if (seen) ++(count == kColored ? counts_.colored : counts_.uncolored);
    const Eigen::RowVector4d world =
        Eigen::RowVector4d(values[0], values[1], values[2], 1) * matrix_;
    Row row{};
    for (std::size_t k = 0; k < 3; ++k) {
      row[k] = seen ? world[static_cast<int>(k)] : kNone;
      row[index_of(Role::red) + k] = values[kPlain + k];
    }
    row[index_of(Role::intensity)] = values[3];
    builder_->add(row);
    progress_.at(rows_.offset());
  }

  [[nodiscard]] std::string format() const {
    std::string text = "PTX";
    if (by_columns_) text += ", matrices by columns";
    if (counts_.missing > 0) {
      text += fmt::format(", {} points fewer than its headers declare", counts_.missing);
    }
    if (counts_.uncolored > 0 && counts_.colored > 0) {
      text += fmt::format(", colours are not used, which {} points lack", counts_.uncolored);
    }
    return text;
  }

  [[noreturn]] void fail_width(double rows, std::size_t count) const {
    if (rows_.offset() >= input_.bytes.size()) fail_cut(rows, "remove its last line, and ");
    const std::string most = count > kColored ? "more than 7" : fmt::format("{}", count);
    fail_at_line(input_, rows_.begin(),
                 width_ == 0 || width_ == count
                     ? fmt::format("{} values in a row, but points of PTX have 4, or 7 with a "
                                   "colour: \"{}\"",
                                   most, excerpt(rows_.line()))
                     : fmt::format("{} values in a row, but the points of this scan have {}: "
                                   "\"{}\"",
                                   most, width_, excerpt(rows_.line())),
                 "Correct this row, or export the file again");
  }

  [[noreturn]] void fail_cut(double rows, std::string_view first) const {
    fail_at_line(input_, begin_,
                 fmt::format("the file ends after {} of the {} points that the scan which begins "
                             "here declares",
                             rows, points_),
                 rows == 0 ? std::string(kAgain)
                           : fmt::format("{}; to use the points that are present, {}write 1 here "
                                         "and {} in the next line",
                                         kAgain, first, rows));
  }

  static constexpr std::string_view kAgain = "Download or export it again";

  const Input& input_;
  TableRows rows_;
  Progress progress_;
  std::optional<CloudBuilder> builder_;
  bool by_columns_;
  Eigen::Matrix4d matrix_ = Eigen::Matrix4d::Identity();
  std::size_t begin_ = 0;  // of the scan, bytes
  double points_ = 0;      // of the scan, as it declares
  std::size_t width_ = 0;  // values of a point of the scan; 0: none is known
  Counts counts_;
};

}  // namespace

bool is_ptx(const Input& input) {
  if (extension(input.name) == ".ptx") return true;
  TextScanner scanner(input);
  for (const std::size_t values : kPtxHead) {
    if (count_cells(scanner.next_line()) != values) return false;
  }
  return true;
}

CloudFile read_ptx(const Input& input) {
  if (std::optional<CloudFile> file = PtxReader(input, false).run()) return std::move(*file);
  return PtxReader(input, true).run().value();
}

}  // namespace palpate::io
