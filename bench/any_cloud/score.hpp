#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "any_cloud/bench_run.hpp"

namespace palpate::any_cloud {

/// What a scene's trace is worth. NaN: the scene has no such number.
struct Score {
  double force_error = 0;   ///< |F - F_ideal| while the ideal touches, RMS, N
  double force_ratio = 0;   ///< |F| / |F_ideal| where contact is required, mean
  double step = 0;          ///< largest change of force in a tick beyond K |dh|, N
  double ideal_step = 0;    ///< the same of the ideal, N
  double lost = 0;          ///< share of required ticks with less than 20 % of the ideal force, %
  double through = 0;       ///< times that three required ticks in a row were lost
  double in_free_air = 0;   ///< ticks with more than 0.05 N where contact is forbidden
  double wrong_side = 0;    ///< ticks with a force turned over 120 degrees, both above 0.1 N
  double height = 0;        ///< |distance of the proxy from the true surface| in contact, mean, s
  double highest = 0;       ///< the largest, s
  double pokes = 0;         ///< strokes and pokes in which contact is required
  double passed = 0;        ///< of them those that went through
  double held = 0;          ///< of all those held by the body 8 spacings outside, the ideal free
  double most_outside = 0;  ///< the largest force there, N
  double over = 0;          ///< share of ticks above 1.3 of the ideal force and the noise in it, %
  double within = 0;        ///< ticks with a proxy 1 s inside the solid, or a force into it
  double caught = 0;        ///< ticks with force where proxy and hand are in the same free space
  double energy = 0;        ///< given to the hand by a stroke, the most, mJ at 1 mm a spacing
  double faults = 0;        ///< ticks that were not finite
  double usual_us = 0;      ///< computing time of a step, median, us
  double slow_us = 0;       ///< 99.9 %
  double slowest_us = 0;    ///< the longest
  double radius = 0;        ///< R, median, s
  double radius_largest = 0;
  double noise = 0;      ///< as preparation sees it, s
  double ideal_off = 0;  ///< ticks in which the ideal itself is wrong: the scene is at fault
};

[[nodiscard]] Score score(const HostileScene& scene, const Rendered& rendered, const Trace& ideal);

/// One seed of one row.
struct Result {
  std::string row;
  std::uint64_t seed = 0;
  std::optional<Score> score;  ///< empty: preparation refused the cloud
  std::string refusal;
};

/// A way to touch a scene. @throws Error when it refuses the cloud.
using Touch = std::function<Rendered(const HostileScene&)>;

/// Makes the scene, touches it in each of these ways and its truth, and compares.
[[nodiscard]] std::vector<Result> run_row(const Row& row, std::uint64_t seed,
                                          const std::vector<Touch>& ways);
[[nodiscard]] Result run_row(const Row& row, std::uint64_t seed, const FieldOptions& field = {});

}  // namespace palpate::any_cloud
