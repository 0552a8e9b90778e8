#include "accuracy/table.hpp"

namespace palpate::accuracy {
namespace {

double normal(const Score& s) {
  return s.normal;
}
double force(const Score& s) {
  return s.force;
}
double ripple(const Score& s) {
  return s.ripple;
}
double height(const Score& s) {
  return s.height;
}
double lost(const Score& s) {
  return 100 * s.lost;
}
double pops(const Score& s) {
  return s.pops;
}
double step(const Score& s) {
  return s.step;
}
double peak(const Score& s) {
  return s.peak;
}
double energy(const Score& s) {
  return 1e3 * s.energy;
}

constexpr double kNone = -1;
constexpr const char* kNormal = "normal, deg";
constexpr const char* kForce = "force, N";
constexpr const char* kRipple = "ripple, N";
constexpr const char* kHeight = "height, mm";
constexpr const char* kLost = "lost, %";
constexpr const char* kPops = "pops";
constexpr const char* kStep = "step, N";

// Table A of evaluation.md, and rows below it that carry no target.
std::vector<Target> independent_targets() {
  return {
      {"plane slide", kNormal, normal, 1.25, "0.27"},
      {"plane slide", kForce, force, 0.07, "0.043"},
      {"plane slide", kRipple, ripple, 0.0005, "0.0001"},
      {"plane slide", kHeight, height, kNone, ""},
      {"light slide", kNormal, normal, 1.3, "0.31"},
      {"light slide", kForce, force, 0.055, "0.041"},
      {"sphere slide", kNormal, normal, 2.2, "2.2"},
      {"sphere slide", kForce, force, 0.115, "0.218"},
      {"sphere slide", kRipple, ripple, 0.001, "0.0063"},
      {"sphere slide", kHeight, height, 0.05, "-0.30"},
      {"box edge", kNormal, normal, 15.5, "10.2"},
      {"box edge", kForce, force, 0.42, "0.390"},
      {"box edge", kLost, lost, 3, "2-15"},
      {"fast tap", kNormal, normal, 1.3, "0.21"},
      {"fast tap", kForce, force, 0.11, "0.042"},
      {"fast tap", kPops, pops, 0, "0"},
      {"thin push", kNormal, normal, 2.4, "0.65"},
      {"thin push", kForce, force, 0.5, "0.140"},
      {"thin push", kPops, pops, 0, "0"},
      {"crease 10 mm", kLost, lost, 0, ""},
      {"crease 10 mm", kStep, step, 0.5, ""},
      {"crease 10 mm", kForce, force, kNone, ""},
      {"static press", kForce, force, kNone, ""},
      {"off the cloud's edge", kStep, step, kNone, ""},
      {"from behind it", kStep, step, kNone, ""},
      {"from behind it", "largest force, N", peak, kNone, ""},
      {"around it", kStep, step, kNone, ""},
      {"around it", "energy, mJ", energy, kNone, ""},
  };
}

}  // namespace

std::vector<Target> targets(NoiseKind noise) {
  std::vector<Target> all = independent_targets();
  if (noise == NoiseKind::independent) return all;
  const bool blurred = noise == NoiseKind::blurred;
  for (Target& target : all) {
    target.limit = kNone;
    target.quoted.clear();
    if (!blurred || target.metric != kNormal) continue;
    if (target.row == "plane slide") target.limit = 3, target.quoted = "1.03";
    if (target.row == "sphere slide") target.limit = 8, target.quoted = "4.2";
  }
  return all;
}

}  // namespace palpate::accuracy
