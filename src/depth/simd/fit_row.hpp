#pragma once

#include <cstdint>

namespace palpate::simd {

// A row of the columns of BlockFits.
struct FitRow {
  std::uint8_t* states;
  float* rho;
  float* variance;
  float* slope_x;
  float* slope_y;
  float* slope_variance;
  float* confidences;
  std::uint8_t* flat;
  std::uint8_t* reach_u;
  std::uint8_t* reach_v;
};

}  // namespace palpate::simd
