#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "accuracy/contender.hpp"

/// Accuracy on real recordings, whose truth are planes of averaged frames.
namespace palpate::accuracy {

struct RecordedOptions {
  std::filesystem::path folder;  ///< of a recording, as docs/sequences.md describes it
  std::size_t first = 0;         ///< number of its first frame that is used
  std::size_t count = 1;         ///< frames through which nothing moved
  int patches = 40;              ///< flat parts that are touched
  int ways = 10000;              ///< through free air
  std::uint64_t seed = 1;
};

/// One way to feel a frame, whose camera is the world: gives what is felt along paths.
struct Feeler {
  std::string name;
  std::function<std::function<Trace(const Path&)>(const DepthFrame&)> shown;
};

/// Each frame in a scene of its own.
[[nodiscard]] Feeler feeler_of(const Contender& contender);

/// Flat parts of a real recording, touched in each of its frames, against planes of the frames'
/// averages; what noise is measured there and what the filter is told; and straight ways through
/// air that is farther from all that a frame shows than 20 mm and than noise takes it. As Markdown.
/// @throws palpate::Error when the recording has no such frames, or nothing flat.
[[nodiscard]] std::string recorded_report(const RecordedOptions& options,
                                          const std::vector<Feeler>& feelers);

}  // namespace palpate::accuracy
