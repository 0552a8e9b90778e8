// Reads the scans of PTX files: grids of points, each with its scanner's pose.
#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

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

class PtxReader {
 public:
  explicit PtxReader(const Input& input)
      : input_(input), rows_(input, 0), progress_(input.options, input.bytes.size()) {}

  CloudFile run() {
    std::size_t scans = 0;
    for (; rows_.next(); ++scans) read_scan();
    if (!builder_) fail(input_, "this PTX file holds no points", "Export it again");
    CloudFile file = builder_->finish("PTX");
    const Eigen::Vector3d stand = input_.scale().cwiseProduct(matrix_.row(3).head<3>().transpose());
    if (scans == 1 && is_usable(stand)) file.cloud.viewpoint = stand;
    return file;
  }

 private:
  using Values = std::array<double, kColored>;

  void read_scan() {
    const std::size_t begin = rows_.begin();
    std::array<double, 2> size{};
    for (std::size_t line = 0; line < kPtxHead.size(); ++line) {
      Values values{};
      const bool there = line == 0 || rows_.next();
      if (!there || !rows_.read(std::span(kInOrder).first(kPtxHead[line]), values)) {
        fail_cut("its header", begin);
      }
      if (line < size.size()) size[line] = values[0];
      if (line < kMatrixBegin) continue;
      for (int k = 0; k < 4; ++k)
        matrix_(static_cast<int>(line - kMatrixBegin), k) = values[static_cast<std::size_t>(k)];
    }
    // What a file of less than 2^53 bytes can hold is counted exactly.
    const double points = size[0] * size[1];
    if (!(size[0] >= 0 && size[1] >= 0)) {
      fail_at_line(input_, begin, fmt::format("a scan of {} columns and {} rows", size[0], size[1]),
                   "Correct these numbers, or export the file again");
    }
    for (double i = 0; i < points; ++i) read_point(begin);
  }

  void read_point(std::size_t scan) {
    Values values{};
    const bool there = rows_.next();
    if (there && !builder_) begin_points();
    if (!there || !rows_.read(std::span(kInOrder).first(values_), values)) {
      fail_cut("the points that it declares", scan);
    }
    const Eigen::RowVector4d local(values[0], values[1], values[2], 1);
    // A scanner writes zeros where nothing came back.
    const bool seen = !local.head<3>().isZero(0);
    const Eigen::RowVector4d world = local * matrix_;
    Row row{};
    for (std::size_t k = 0; k < 3; ++k) {
      row[k] = seen ? world[static_cast<int>(k)] : std::numeric_limits<double>::quiet_NaN();
      row[index_of(Role::red) + k] = values[kPlain + k];
    }
    row[index_of(Role::intensity)] = values[3];
    builder_->add(row);
    progress_.at(rows_.offset());
  }

  // The first point shows whether there are colours.
  void begin_points() {
    const bool colors = count_cells(rows_.line()) == kColored;
    values_ = colors ? kColored : kPlain;
    // A value takes a digit and a space.
    const std::size_t room = (input_.bytes.size() - rows_.begin()) / (2 * values_) + 1;
    builder_.emplace(input_, Columns{.colors = colors, .intensities = true}, ColorScale::byte,
                     room);
  }

  [[noreturn]] void fail_cut(std::string_view where, std::size_t scan) const {
    fail_at_line(input_, scan,
                 fmt::format("the file ends within {} of the scan that begins here", where),
                 "Download or export it again");
  }

  const Input& input_;
  TableRows rows_;
  Progress progress_;
  std::optional<CloudBuilder> builder_;
  std::size_t values_ = kPlain;
  Eigen::Matrix4d matrix_ = Eigen::Matrix4d::Identity();
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
  return PtxReader(input).run();
}

}  // namespace palpate::io
