// Defines vectors of four lanes, for loops over blocks and points.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <cstring>

namespace palpate {

inline constexpr int kLanes = 4;  ///< blocks or points side by side
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
typedef std::int32_t Ints __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

template <class Lanes, class T>
[[nodiscard]] Lanes load(const T* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

template <class Lanes, class T>
void store(T* to, const Lanes& lanes) {
  std::memcpy(to, &lanes, sizeof lanes);
}

[[nodiscard]] inline Floats least(const Floats& a, const Floats& b) {
  return b < a ? b : a;
}

/// Is any (are all) of four comparisons true?
[[nodiscard]] inline bool any(const Ints& lanes) {
  std::uint64_t halves[2];
  std::memcpy(halves, &lanes, sizeof lanes);
  return (halves[0] | halves[1]) != 0;
}
[[nodiscard]] inline bool all(const Ints& lanes) {
  return !any(~lanes);
}

/// Vectors side by side; sums in the order that Eigen has for one.
struct Vectors {
  Floats x, y, z;

  [[nodiscard]] friend Vectors operator+(const Vectors& a, const Vectors& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[nodiscard]] friend Vectors operator-(const Vectors& a, const Vectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[nodiscard]] friend Vectors operator*(const Floats& a, const Vectors& b) {
    return {a * b.x, a * b.y, a * b.z};
  }
  [[nodiscard]] friend Floats dot(const Vectors& a, const Vectors& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
  }
  [[nodiscard]] friend Vectors operator*(const Eigen::Matrix3f& a, const Vectors& b) {
    const auto row = [&](int i) { return a(i, 0) * b.x + (a(i, 1) * b.y + a(i, 2) * b.z); };
    return {row(0), row(1), row(2)};
  }
  [[nodiscard]] Ints zero() const { return (x == 0) & (y == 0) & (z == 0); }
  [[nodiscard]] Eigen::Vector3f lane(int l) const { return {x[l], y[l], z[l]}; }
};

[[nodiscard]] inline Vectors choose(const Ints& which, const Vectors& a, const Vectors& b) {
  return {which ? a.x : b.x, which ? a.y : b.y, which ? a.z : b.z};
}

[[nodiscard]] inline Vectors all_lanes(const Eigen::Vector3f& v) {
  return {Floats{} + v.x(), Floats{} + v.y(), Floats{} + v.z()};
}

/// Vectors that stand one after the other.
[[nodiscard]] inline Vectors load(const Eigen::Vector3f* from) {
  const auto a = load<Floats>(from->data());
  const auto b = load<Floats>(from->data() + kLanes);
  const auto c = load<Floats>(from->data() + 2 * kLanes);
  return {__builtin_shufflevector(__builtin_shufflevector(a, b, 0, 3, 6, 6), c, 0, 1, 2, 5),
          __builtin_shufflevector(__builtin_shufflevector(a, b, 1, 4, 7, 7), c, 0, 1, 2, 6),
          __builtin_shufflevector(__builtin_shufflevector(b, c, 1, 4, 7, 7), a, 6, 0, 1, 2)};
}

inline void store(Eigen::Vector3f* to, const Vectors& v) {
  const Floats xy = __builtin_shufflevector(v.x, v.y, 0, 4, 1, 5);   // x0 y0 x1 y1
  const Floats xy2 = __builtin_shufflevector(v.x, v.y, 2, 6, 3, 7);  // x2 y2 x3 y3
  store(to->data(), __builtin_shufflevector(xy, v.z, 0, 1, 4, 2));
  store(to->data() + kLanes,
        __builtin_shufflevector(__builtin_shufflevector(xy, v.z, 3, 5, 3, 5), xy2, 0, 1, 4, 5));
  store(to->data() + 2 * kLanes, __builtin_shufflevector(xy2, v.z, 6, 2, 3, 7));
}

}  // namespace palpate
