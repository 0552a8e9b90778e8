// Sorts points into files, one for each chunk.
#include <algorithm>
#include <filesystem>
#include <span>
#include <string>

#include "extras/tile/out_file.hpp"
#include "extras/tile/pieces.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer = std::size_t{1} << 18U;  // bytes of a chunk written at once

class ChunkFiles {
 public:
  ChunkFiles(const Plan& plan, const fs::path& folder)
      : plan_(plan), folder_(folder), sizes_(plan.chunks.size()), buffers_(sizes_.size()) {}

  void add(StorePoint point, std::uint16_t color_factor) {
    for (std::uint16_t& c : point.color) c = static_cast<std::uint16_t>(c * color_factor);
    find(point.numbers);
    std::vector<std::byte>& buffer = buffers_[last_];
    const std::size_t begin = buffer.size();
    buffer.resize(begin + plan_.layout.size());
    plan_.layout.put(point, std::span(buffer).subspan(begin));
    if (buffer.size() >= kBuffer) flush(last_, false);
  }

  // Writes what is left. @return bytes of all.
  std::uint64_t close() {
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
      if (sizes_[i] + buffers_[i].size() > 0) flush(i, true);
      all += sizes_[i];
    }
    return all;
  }

 private:
  // Makes `last_` the chunk of a point; that of the point before it is the likeliest.
  void find(const Numbers& numbers) {
    const int bits = plan_.frame.bits;
    const auto holds = [&](const Cell& cell) { return cell_of(numbers, cell.level, bits) == cell; };
    if (holds(plan_.chunks[last_])) return;
    const auto found = std::ranges::partition_point(plan_.chunks, [&](const Cell& cell) {
      return before(cell.at, cell_of(numbers, cell.level, bits).at);
    });
    if (found == plan_.chunks.end() || !holds(*found)) {
      throw Error("the inputs have changed while they were read. Run it again with --force.");
    }
    last_ = static_cast<std::size_t>(found - plan_.chunks.begin());
  }

  void flush(std::size_t chunk, bool sync) {
    OutFile file(folder_ / std::to_string(chunk), sizes_[chunk]);
    file.append(buffers_[chunk]);
    if (sync) file.sync();
    sizes_[chunk] = file.size();
    buffers_[chunk].clear();
  }

  const Plan& plan_;
  fs::path folder_;
  std::vector<std::uint64_t> sizes_;  // bytes that are in the files
  std::vector<std::vector<std::byte>> buffers_;
  std::size_t last_ = 0;
};

}  // namespace

void distribute(const std::vector<TileInput>& inputs, const Plan& plan, const fs::path& folder,
                const Report& report) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  ChunkFiles files(plan, folder);
  read_all(inputs, plan.frame, report, [&](const Piece& piece) {
    for (const StorePoint& point : piece.points) {
      files.add(point, plan.color_factors[piece.input]);
    }
  });
  if (files.close() == plan.points * plan.layout.size()) return;
  throw Error("the inputs have changed while they were read. Run it again with --force.");
}

}  // namespace palpate::io::tile
