// Reads LAS files in slices of records and LAZ files in their chunks, so that they may be larger
// than memory.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "extras/tile/input.hpp"
#include "io/cloud_builder.hpp"
#include "io/file_bytes.hpp"
#include "io/las_coordinates.hpp"
#include "io/laz/laz_file.hpp"
#include "io/laz/points.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::size_t kSlice = 65536;  // records that are read at once (judgement)

class LasFile {
 public:
  LasFile(const std::string& path, const ReadOptions& options)
      : file_(path),
        options_(options),
        head_(read_las_head(file_)),
        header_(read_las_header(input())),
        unit_(in_las_unit(input(), header_).unit) {
    const Eigen::Vector3d scale(unit_.plan, unit_.plan, unit_.height);
    scale_ = scale.cwiseProduct(header_.scale);
    offset_ = scale.cwiseProduct(header_.offset);
    if (header_.compressed) {
      chunks_ = laz::read_chunk_table(input(), header_, parts_of(file_));
    } else {
      cut();
    }
  }

  [[nodiscard]] TileInput described() const {
    TileInput input{.name = file_.name(), .format = header_.name(), .unit = unit_};
    input.points = header_.points;
    input.pieces = chunks_.size();
    const Eigen::Vector3d scale(unit_.plan, unit_.plan, unit_.height);
    input.box = {scale.cwiseProduct(header_.lower), scale.cwiseProduct(header_.upper)};
    input.steps = scale_;
    input.origin = offset_;
    return input;
  }

  [[nodiscard]] std::vector<InputPoint> read(std::size_t piece) const {
    std::vector<InputPoint> points;
    points.reserve(chunks_[piece].points);
    for (const LasPoint& point : decode(piece)) {
      const Eigen::Vector3d numbers(point.number[0], point.number[1], point.number[2]);
      const Eigen::Vector3d position = numbers.cwiseProduct(scale_) + offset_;
      if (point.withheld || !is_usable(position)) continue;
      points.push_back({position, point.intensity, point.color});
    }
    return points;
  }

 private:
  [[nodiscard]] Input input() const { return {head_.span(), file_.name(), options_}; }

  // Makes chunks of records that are not compressed.
  void cut() {
    const std::size_t begin = std::min(header_.points_offset, file_.size());
    const std::size_t present = (file_.size() - begin) / header_.record_size;
    if (present < header_.points) {
      fail_at_byte(input(), file_.size(),
                   fmt::format("the file ends after {} of {} points", present, header_.points),
                   "Download or copy it again");
    }
    for (std::size_t first = 0; first < header_.points; first += kSlice) {
      const std::size_t count = std::min(kSlice, header_.points - first);
      chunks_.push_back({header_.points_offset + first * header_.record_size,
                         count * header_.record_size, first, count});
    }
  }

  [[nodiscard]] std::vector<LasPoint> decode(std::size_t piece) const {
    const laz::Chunk& chunk = chunks_[piece];
    std::vector<LasPoint> points(chunk.points);
    const Bytes bytes = file_.read(chunk.offset, chunk.bytes);
    if (header_.compressed && !points.empty()) {
      laz::require_whole(input(), chunk.offset,
                         fmt::format("chunk {} of {}", piece + 1, chunks_.size()),
                         laz::decode_points(header_, bytes.span(), points), points.size());
      return points;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = las_point(header_, bytes.span().data() + i * header_.record_size);
    }
    return points;
  }

  OpenFile file_;
  ReadOptions options_;
  Bytes head_;
  LasHeader header_;
  FileUnit unit_;
  Eigen::Vector3d scale_;           // m
  Eigen::Vector3d offset_;          // m
  std::vector<laz::Chunk> chunks_;  // of a LAS file: slices
};

}  // namespace

TileInput open_las(const std::string& path, const ReadOptions& options) {
  const auto file = std::make_shared<const LasFile>(path, options);
  TileInput input = file->described();
  input.read = [file](std::size_t piece) { return file->read(piece); };
  return input;
}

}  // namespace palpate::io::tile
