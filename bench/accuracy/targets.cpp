// Lists the targets of table A.
#include "accuracy/table.hpp"

namespace palpate::accuracy {
namespace {

using Metric = double (*)(const Score&);

constexpr Metric normal = [](const Score& s) -> double { return s.normal; };
constexpr Metric force = [](const Score& s) -> double { return s.force; };
constexpr Metric ripple = [](const Score& s) -> double { return s.ripple; };
constexpr Metric height = [](const Score& s) -> double { return s.height; };
constexpr Metric lost = [](const Score& s) -> double { return 100 * s.lost; };
constexpr Metric pops = [](const Score& s) -> double { return s.pops; };
constexpr Metric step = [](const Score& s) -> double { return s.step; };
constexpr Metric peak = [](const Score& s) -> double { return s.peak; };
constexpr Metric energy = [](const Score& s) -> double { return 1e3 * s.energy; };

constexpr Limit kNone;
constexpr const char* kNormal = "normal, deg";
constexpr const char* kForce = "force, N";
constexpr const char* kRipple = "ripple, N";
constexpr const char* kHeight = "height, mm";
constexpr const char* kLost = "lost, %";
constexpr const char* kPops = "pops";
constexpr const char* kStepTarget = "step, N";

constexpr Limit at_most(double median, double worst = -1) {
  return {median, worst};
}

// Table A, and rows below it that carry no target.
std::vector<Target> independent_targets() {
  return {
      {"plane slide", kNormal, normal, at_most(1.25), at_most(0.2, 0.4), "0.27"},
      {"plane slide", kForce, force, at_most(0.07), at_most(0.016, 0.025), "0.043"},
      {"plane slide", kRipple, ripple, at_most(0.0005), at_most(0.0003), "0.0001"},
      {"plane slide", kHeight, height, kNone, kNone, ""},
      {"light slide", kNormal, normal, at_most(1.3), at_most(0.25, 0.4), "0.31"},
      {"light slide", kForce, force, at_most(0.055), at_most(0.015), "0.041"},
      {"sphere slide", kNormal, normal, at_most(2.2), at_most(1.7, 2.0), "2.2"},
      {"sphere slide", kForce, force, at_most(0.115), at_most(0.085, 0.11), "0.218"},
      {"sphere slide", kRipple, ripple, at_most(0.001), at_most(0.0007), "0.0063"},
      {"sphere slide", kHeight, height, at_most(0.05), at_most(0.1), "-0.30"},
      {"box edge", kNormal, normal, at_most(15.5), at_most(10), "10.2"},
      {"box edge", kForce, force, at_most(0.42), at_most(0.3), "0.390"},
      {"box edge", kLost, lost, at_most(3), at_most(1.5), "2-15"},
      {"fast tap", kNormal, normal, at_most(1.3), at_most(0.2, 0.6), "0.21"},
      {"fast tap", kForce, force, at_most(0.11), at_most(0.02), "0.042"},
      {"fast tap", kPops, pops, at_most(0), at_most(0), "0"},
      {"thin push", kNormal, normal, at_most(2.4), at_most(0.25, 0.4), "0.65"},
      {"thin push", kForce, force, at_most(0.5), at_most(0.06), "0.140"},
      {"thin push", kPops, pops, at_most(0), at_most(0), "0"},
      {"crease 10 mm", kLost, lost, at_most(0), at_most(0), ""},
      {"crease 10 mm", kStepTarget, step, at_most(0.5), at_most(0.5), ""},
      {"crease 10 mm", kForce, force, kNone, kNone, ""},
      {"static press", kForce, force, kNone, kNone, ""},
      {"off the cloud's edge", kStepTarget, step, kNone, kNone, ""},
      {"from behind it", kStepTarget, step, kNone, kNone, ""},
      {"from behind it", "largest force, N", peak, kNone, kNone, ""},
      {"around it", kStepTarget, step, kNone, kNone, ""},
      {"around it", "energy, mJ", energy, kNone, kNone, ""},
  };
}

}  // namespace

std::vector<Target> targets(NoiseKind noise) {
  std::vector<Target> all = independent_targets();
  if (noise == NoiseKind::independent) return all;
  const bool blurred = noise == NoiseKind::blurred;
  for (Target& target : all) {
    target.points = target.organised = kNone;
    target.quoted.clear();
    if (!blurred || target.metric != kNormal) continue;
    if (target.row == "plane slide") {
      target.points = at_most(3);
      target.organised = at_most(0.8);
      target.quoted = "1.03";
    } else if (target.row == "sphere slide") {
      target.points = at_most(8);
      target.organised = at_most(3.6);
      target.quoted = "4.2";
    }
  }
  return all;
}

}  // namespace palpate::accuracy
