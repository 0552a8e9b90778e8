#pragma once

// Running sums over blocks. In an anonymous namespace: see windows.inl.

#include "depth/simd/windows.inl"

namespace palpate::simd {
namespace {

constexpr double kWeights[5] = {0, 12, 6, 4, 3};  // 12 / pixels; 0: filled

void build_table(const WindowTable& table, const BlockRows& filled) noexcept {
  const std::ptrdiff_t line = std::ptrdiff_t{kWindowSums} * (table.columns + 1);
  std::memset(table.sums, 0, sizeof(double) * static_cast<std::size_t>(line));
  for (int r = 0; r < table.rows; ++r) {
    const std::ptrdiff_t from = (table.first_row + r) * filled.stride + table.first_column;
    const double* above = table.sums + r * line + kWindowSums;
    double* to = table.sums + (r + 1) * line;
    const double v = r - table.rows / 2;
    Doubles low{};
    Doubles high{};
    std::memset(to, 0, sizeof(double) * kWindowSums);
    to += kWindowSums;
    for (int c = 0; c < table.columns; ++c, above += kWindowSums, to += kWindowSums) {
      const float rho = filled.rho[from + c];
      const double q = static_cast<double>(static_cast<int>(rho * float(kRhoUnits) + .5F));
      const double u = c - table.columns / 2;
      const double count = rho > 0 ? kBlock + kWeights[filled.counts[from + c]] : 0;
      low += q * Doubles{1, u, v, u * u};
      high += Doubles{q * (u * v), q * (v * v), q * q, count};
      const Doubles low_here = load(above) + low;
      const Doubles high_here = load(above + 4) + high;
      std::memcpy(to, &low_here, sizeof low_here);
      std::memcpy(to + 4, &high_here, sizeof high_here);
    }
  }
}

}  // namespace
}  // namespace palpate::simd
