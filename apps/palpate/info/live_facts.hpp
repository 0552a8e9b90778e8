#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>

#include "apps/palpate/cli/arguments.hpp"

namespace palpate::app {

/// What some frames of a camera or sequence show of it.
struct LiveFacts {
  CloudArgument argument;
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Pinhole pinhole;
  bool distorted = false;
  bool posed = false;        ///< frames tell where they were taken
  std::size_t frames = 0;    ///< that were looked at
  std::size_t repeated = 0;  ///< of them bit for bit like the one before
  std::size_t failures = 0;  ///< reads that failed
  std::size_t unposed = 0;   ///< frames without a pose among those with one
  double rate = 0;           ///< frames a second by their stamps, Hz
  double valid = 0;          ///< share of pixels with a depth
  double depth = 0;          ///< median, m
  double nearest = 0;        ///< a hundredth of the depths is nearer, m
  double farthest = 0;       ///< a hundredth is farther, m
  NoiseModel noise;          ///< as measured
};

/// Looks at the first 30 frames, or as many as there are. @throws Error when there is none.
[[nodiscard]] LiveFacts study_live(const CloudArgument& argument);

void print_facts(const LiveFacts& facts, std::FILE* out);
[[nodiscard]] nlohmann::ordered_json json_facts(const LiveFacts& facts);

}  // namespace palpate::app
