// Reads LAS files in slices of records and LAZ files in their chunks, so that they may be larger
// than memory.
#include <fmt/format.h>

#include <algorithm>

#include "io/file_bytes.hpp"
#include "io/laz/laz_file.hpp"
#include "io/laz/points.hpp"
#include "io/tile/input.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::size_t kSlice = 65536;  // records that are read at once (judgement)

class LasInput final : public TileInput {
 public:
  LasInput(const std::string& path, double scale) : file_(path) {
    const Bytes head = read_las_head(file_);
    header_ = read_las_header({head.span(), path, options_});
    find_chunks({head.span(), path, options_});
    facts_.name = path;
    facts_.format = header_.name();
    facts_.points = header_.points;
    facts_.scale = scale * header_.scale;
    facts_.offset = scale * header_.offset;
    facts_.box = {scale * header_.lower, scale * header_.upper};
    facts_.colors = header_.color_offset().has_value();
    facts_.surveyed = true;
  }

  [[nodiscard]] const Facts& facts() const override { return facts_; }
  [[nodiscard]] std::size_t pieces() const override { return chunks_.size(); }

  [[nodiscard]] std::vector<LasPoint> read(std::size_t piece) const override {
    const laz::Chunk& chunk = chunks_[piece];
    std::vector<LasPoint> points(chunk.points);
    const Bytes bytes = file_.read(chunk.place, chunk.bytes);
    if (!header_.compressed) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        points[i] = las_point(header_, bytes.span().data() + i * header_.record_size);
      }
    } else if (!points.empty()) {
      decode(bytes.span(), piece, points);
    }
    return points;
  }

 private:
  void find_chunks(const Input& head) {
    if (header_.compressed) {
      chunks_ = laz::read_chunk_table(head, header_, parts_of(file_));
      return;
    }
    const std::size_t begin = std::min(header_.points_offset, file_.size());
    const std::size_t present = (file_.size() - begin) / header_.record_size;
    if (present < header_.points) {
      fail_at_byte(head, file_.size(),
                   fmt::format("the file ends after {} of {} points", present, header_.points),
                   "Download or copy it again");
    }
    for (std::size_t first = 0; first < header_.points; first += kSlice) {
      const std::size_t count = std::min(kSlice, header_.points - first);
      chunks_.push_back({header_.points_offset + first * header_.record_size,
                         count * header_.record_size, first, count});
    }
  }

  void decode(std::span<const std::byte> bytes, std::size_t piece,
              std::span<LasPoint> points) const {
    const std::size_t decoded = laz::decode_points(header_, bytes, points);
    if (decoded == points.size()) return;
    throw Error(fmt::format(
        "{}, byte {}: chunk {} of {} ends inside its point {} of {}. Download "
        "the file again; \"lasinfo\" or \"pdal info\" tests it.",
        file_.name(), chunks_[piece].place, piece + 1, chunks_.size(), decoded + 1, points.size()));
  }

  OpenFile file_;
  ReadOptions options_;
  LasHeader header_;
  Facts facts_;
  std::vector<laz::Chunk> chunks_;  // of a LAS file: slices
};

}  // namespace

std::unique_ptr<TileInput> open_las(const std::string& path, double scale) {
  return std::make_unique<LasInput>(path, scale);
}

}  // namespace palpate::io::tile
