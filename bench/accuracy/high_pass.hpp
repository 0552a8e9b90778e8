#pragma once

#include <vector>

namespace palpate::accuracy {

/// A signal without what is slower than `cutoff` (Hz): Butterworth of second order, run forwards
/// and backwards, so that nothing is delayed. `rate` in Hz.
[[nodiscard]] std::vector<double> high_pass(const std::vector<double>& signal, double cutoff,
                                            double rate);

/// Likewise, a signal without what is faster than `cutoff`.
[[nodiscard]] std::vector<double> low_pass(const std::vector<double>& signal, double cutoff,
                                           double rate);

}  // namespace palpate::accuracy
