#pragma once

#include "accuracy/score.hpp"
#include "streams/stream_contender.hpp"
#include "streams/stream_setup.hpp"

namespace palpate::streams {

/// The forces on one tool, tick by tick.
struct StreamTrace {
  accuracy::Trace felt;                 ///< raw K (p - h), and the proxy
  std::vector<Eigen::Vector3d> normal;  ///< of the field at the proxy, unit; zero: no surface there
  std::vector<double> radius;           ///< R there, m
  std::vector<std::size_t> swaps;       ///< ticks in which a new surface began
};

/// Plays the set-up in simulated time: frames are filtered and published 2 ms before their surfaces
/// start, fields and proxies step at 1 kHz. One trace for each of the contender's tools.
[[nodiscard]] std::vector<StreamTrace> run_stream(const Setup& setup, const Contender& contender);

}  // namespace palpate::streams
