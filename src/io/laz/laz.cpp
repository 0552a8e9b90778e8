// Decodes the points of LAZ files, chunk by chunk on all cores.
#include <fmt/format.h>

#include <atomic>
#include <thread>

#include "geometry/parallel.hpp"
#include "io/laz/laz_file.hpp"
#include "io/laz/points.hpp"

namespace palpate::io::laz {
namespace {

void check_memory(const Input& input, const LasHeader& header) {
  if (can_hold(header, input.bytes.size(), header.points)) return;
  fail(input,
       fmt::format("announces {} points in {} bytes, more than any survey is compressed",
                   header.points, input.bytes.size()),
       "If you trust it, convert it with \"pdal translate IN.laz OUT.las\"");
}

}  // namespace

std::unique_ptr<LasPoint[]> read_points(const Input& input, const LasHeader& header) {
  const std::vector<Chunk> chunks = read_chunk_table(input, header);
  check_memory(input, header);
  auto points = std::make_unique_for_overwrite<LasPoint[]>(header.points);
  std::vector<std::size_t> decoded(chunks.size());
  std::atomic<std::size_t> done = 0;
  Progress progress(input.options, header.points + header.points / kDecodingShare);
  const std::thread::id caller = std::this_thread::get_id();
  detail::parallel_each(chunks.size(), 1, [&](std::size_t i) {
    const Chunk& chunk = chunks[i];
    decoded[i] = decode_points(header, input.bytes.subspan(chunk.offset, chunk.bytes),
                               {points.get() + chunk.first, chunk.points});
    done += chunk.points;
    // The caller's callback is for its own thread; it throws to give up.
    if (std::this_thread::get_id() == caller) progress.at(done);
  });
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    require_whole(input, chunks[i].offset, fmt::format("chunk {} of {}", i + 1, chunks.size()),
                  decoded[i], chunks[i].points);
  }
  return points;
}

}  // namespace palpate::io::laz
