// Numbers of kLanes points side by side, and vectors of three of them. Included by sums.inl, in an
// anonymous namespace as that.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "field/simd/sums.hpp"

namespace palpate::simd {
namespace {

// In an expression a number beside them stands in each lane; a mask's lanes are 0 or -1.
typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));
typedef std::int64_t Mask __attribute__((vector_size(kLanes * sizeof(double))));

inline Lanes load(const double* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline Lanes same(double value) {
  return value - Lanes{};
}
constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();  // the sign's bit
inline Lanes absolute(const Lanes& v) {
  return (Lanes)((Mask)v & ~kSign);
}
inline Lanes positive(const Lanes& v) {  // max(v, 0)
  return 0.5 * (v + absolute(v));
}
inline Lanes root(const Lanes& v) {
  double lanes[kLanes];
  std::memcpy(lanes, &v, sizeof v);
  for (double& lane : lanes) lane = std::sqrt(lane);
  return load(lanes);
}
inline bool any(const Mask& mask) {
  return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
}

// In a fixed order, so that every level gives the same bits.
inline double sum(const Lanes& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

// An aggregate would take three numbers in braces for lanes of x, and nothing would warn.
struct Vector {
  Vector() = default;
  Vector(const Lanes& to_x, const Lanes& to_y, const Lanes& to_z) : x(to_x), y(to_y), z(to_z) {}
  Lanes x{};
  Lanes y{};
  Lanes z{};
};
inline Vector same(const double v[3]) {
  return {same(v[0]), same(v[1]), same(v[2])};
}
inline Lanes dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline void add(Vector& to, const Lanes& w, const Vector& v) {
  to.x += w * v.x;
  to.y += w * v.y;
  to.z += w * v.z;
}
inline void store(const Vector& v, double scale, double out[3]) {
  out[0] = scale * sum(v.x);
  out[1] = scale * sum(v.y);
  out[2] = scale * sum(v.z);
}
inline Vector load3(const double* const column[3], std::uint32_t i) {
  return {load(column[0] + i), load(column[1] + i), load(column[2] + i)};
}
inline Vector offsets(const Columns& c, std::uint32_t i, const double x[3]) {
  const Vector p = load3(c.position, i);
  return {p.x - x[0], p.y - x[1], p.z - x[2]};
}

}  // namespace
}  // namespace palpate::simd
