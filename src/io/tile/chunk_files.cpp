// Sorts points into files, one for each chunk.
#include "io/tile/chunk_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/tile/out_file.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18U;  // bytes of a chunk written at once

// A place on the Morton curve: the upper and the lower 15 bits of each number.
using Code = std::pair<std::uint64_t, std::uint64_t>;

Code code_of(const Numbers& n) {
  constexpr int kLower = 15;
  constexpr std::uint32_t kMask = (1U << kLower) - 1;
  return {morton({n[0] >> kLower, n[1] >> kLower, n[2] >> kLower}),
          morton({n[0] & kMask, n[1] & kMask, n[2] & kMask})};
}

class ChunkFiles {
 public:
  ChunkFiles(const Plan& plan, std::filesystem::path folder)
      : plan_(plan),
        folder_(std::move(folder)),
        sizes_(plan.chunks.size()),
        buffers_(sizes_.size()) {
    for (const Chunk& chunk : plan.chunks) {
      Numbers first = chunk.cell.at;
      for (std::uint32_t& n : first) n <<= plan.frame.bits - chunk.cell.level;
      starts_.push_back(code_of(first));
    }
  }

  void add(StorePoint point, std::uint16_t color_factor) {
    for (std::uint16_t& c : point.color) c = static_cast<std::uint16_t>(c * color_factor);
    find(point.numbers);
    std::vector<std::byte>& buffer = buffers_[last_];
    const std::size_t begin = buffer.size();
    buffer.resize(begin + plan_.layout.size());
    plan_.layout.put(point, std::span(buffer).subspan(begin));
    if (buffer.size() >= kBuffer) flush(last_, false);
  }

  // @throws Error where a chunk has not the points that were counted in it.
  void close() {
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
      flush(i, true);
      if (sizes_[i] == plan_.chunks[i].points * plan_.layout.size()) continue;
      throw Error("the inputs have changed while they were read. Run it again with --force.");
    }
  }

 private:
  // Makes `last_` the chunk of a point; that of the point before it is the likeliest.
  void find(const Numbers& numbers) {
    const Cell& cell = plan_.chunks[last_].cell;
    if (cell_of(numbers, cell.level, plan_.frame.bits) == cell) return;
    const auto behind = std::ranges::upper_bound(starts_, code_of(numbers));
    last_ = static_cast<std::size_t>(behind - starts_.begin());
    if (last_ > 0) --last_;
  }

  void flush(std::size_t chunk, bool sync) {
    OutFile file(chunk_file(folder_, chunk), sizes_[chunk]);
    file.append(buffers_[chunk]);
    if (sync) file.sync();
    sizes_[chunk] = file.size();
    buffers_[chunk].clear();
  }

  const Plan& plan_;
  std::filesystem::path folder_;
  std::vector<Code> starts_;
  std::vector<std::uint64_t> sizes_;  // bytes that are in the files
  std::vector<std::vector<std::byte>> buffers_;
  std::size_t last_ = 0;
};

}  // namespace

std::filesystem::path chunk_file(const std::filesystem::path& folder, std::size_t chunk) {
  return folder / fmt::format("{:05}", chunk);
}

void distribute(const Inputs& inputs, const Plan& plan, const std::filesystem::path& folder,
                const Told& told) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  ChunkFiles files(plan, folder);
  read_all(inputs, plan.frame, told, [&](const Piece& piece) {
    for (const StorePoint& point : piece.points) {
      files.add(point, plan.color_factors[piece.input]);
    }
  });
  files.close();
}

}  // namespace palpate::io::tile
