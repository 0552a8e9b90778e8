// Filters a signal forwards and backwards with a Butterworth section.
#include "accuracy/high_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::accuracy {
namespace {

// y_k = gain (x_k + middle x_{k-1} + x_{k-2}) - a1 y_{k-1} - a2 y_{k-2}
struct Section {
  double gain = 0;
  double middle = 0;
  double a1 = 0;
  double a2 = 0;
  double at_rest = 0;  // gain for what never changes
};

// The analogues s^2 / (s^2 + sqrt(2) s + 1) and 1 / (...) through the bilinear transform, with the
// cut-off frequency prewarped.
Section butterworth(double cutoff, double rate, bool high) {
  const double w = std::tan(std::numbers::pi * cutoff / rate);
  const double norm = 1 + std::numbers::sqrt2 * w + w * w;
  Section section{1 / norm, -2, 2 * (w * w - 1) / norm,
                  (1 - std::numbers::sqrt2 * w + w * w) / norm, 0};
  if (!high) {
    section.gain = w * w / norm;
    section.middle = 2;
    section.at_rest = 1;
  }
  return section;
}

// Starts at rest on the first value, as if that had been there for ever.
void run(const Section& section, std::vector<double>& signal) {
  double x1 = signal.front();
  double x2 = x1;
  double y1 = section.at_rest * x1;
  double y2 = y1;
  for (double& value : signal) {
    const double x = value;
    value = section.gain * (x + section.middle * x1 + x2) - section.a1 * y1 - section.a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = value;
  }
}

std::vector<double> both_ways(const Section& section, const std::vector<double>& signal) {
  if (signal.empty()) return {};
  std::vector<double> out = signal;
  run(section, out);
  std::reverse(out.begin(), out.end());
  run(section, out);
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<double> high_pass(const std::vector<double>& signal, double cutoff, double rate) {
  return both_ways(butterworth(cutoff, rate, true), signal);
}

std::vector<double> low_pass(const std::vector<double>& signal, double cutoff, double rate) {
  return both_ways(butterworth(cutoff, rate, false), signal);
}

}  // namespace palpate::accuracy
