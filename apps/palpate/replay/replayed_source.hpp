#pragma once

#include <cstdint>
#include <string>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/replay/recorded_frames.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "bag/mcap_reader.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

/// What came to one source of a recorded run, in order, into a source of `scene`, which outlives
/// it. One thread. What is damaged throws Error or nlohmann::json::exception.
class ReplayedSource {
 public:
  /// `json`: the source's part of the set-up, the one at `index`. One that stands still has its
  /// surface. `reader`: of the file.
  ReplayedSource(const std::string& path, const Json& json, std::size_t index, Scene& scene,
                 const bag::McapReader& reader);

  /// Pushes until so many snapshots are published. False: the file does not tell how they came
  /// about.
  [[nodiscard]] bool push_until(std::uint64_t publication);

  /// Its supports are as wide as they were, m.
  void widen(double least_radius);

 private:
  bool push_next();
  void do_again(const RecordedFrame& recorded);

  RecordedFrames frames_;
  LoadedSource from_;
  Source* source_;
  bool lives_;
  std::uint64_t done_ = 0;  // publications
};

}  // namespace palpate::app
