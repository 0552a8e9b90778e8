// The body of both copies of the plane fits. Everything in it has internal linkage.
#include <cmath>
#include <cstring>

#include "geometry/simd/joins.hpp"

namespace palpate::simd {
namespace {

template <std::size_t kLanes>
struct PlaneFits {
  static_assert(kQueries % kLanes == 0);
  typedef double Doubles __attribute__((vector_size(kLanes * sizeof(double))));

  struct Vector {
    Doubles x, y, z;
    Doubles dot(const Vector& v) const { return x * v.x + y * v.y + z * v.z; }
    Vector cross(const Vector& v) const {
      return {y * v.z - z * v.y, z * v.x - x * v.z, x * v.y - y * v.x};
    }
  };

  struct Symmetric {
    Doubles xx, xy, xz, yy, yz, zz;
  };

  static inline Doubles load(const float* from) {
    double numbers[kLanes];
    for (std::size_t l = 0; l < kLanes; ++l) numbers[l] = static_cast<double>(from[l]);
    Doubles v;
    std::memcpy(&v, numbers, sizeof v);
    return v;
  }
  static inline void store(double* to, const Doubles& v) { std::memcpy(to, &v, sizeof v); }
  static inline Doubles same(double value) { return value - Doubles{}; }
  static inline Doubles greater(const Doubles& a, const Doubles& b) { return a < b ? b : a; }
  static inline Doubles root(const Doubles& v) {
    double numbers[kLanes];
    store(numbers, v);
    for (double& number : numbers) number = std::sqrt(number);
    Doubles roots;
    std::memcpy(&roots, numbers, sizeof roots);
    return roots;
  }

  // Scaled to a trace of 1; `trace` is what it was.
  static Symmetric covariance(const Row* moments, std::size_t q, Doubles& trace) {
    const Doubles n = greater(load(moments[0] + q), same(1));
    const Doubles per = 1. / n;
    const auto row = [&](std::size_t k) { return load(moments[k] + q) * per; };
    const Vector mean{row(1), row(2), row(3)};
    const Symmetric c{row(4) - mean.x * mean.x, row(5) - mean.x * mean.y, row(6) - mean.x * mean.z,
                      row(7) - mean.y * mean.y, row(8) - mean.y * mean.z, row(9) - mean.z * mean.z};
    trace = greater(c.xx + c.yy + c.zz, same(0));
    const Doubles scale = 1. / greater(trace, same(1e-300));
    return {c.xx * scale, c.xy * scale, c.xz * scale, c.yy * scale, c.yz * scale, c.zz * scale};
  }

  // The smallest root of x^3 - x^2 + c x - d, the characteristic polynomial, whose roots are all
  // real and not negative: Laguerre's method from zero rises to it and triples the digits each
  // time.
  static Doubles smallest_root(const Doubles& c, const Doubles& d) {
    Doubles x{};
    for (int i = 0; i < 4; ++i) {
      const Doubles value = d - x * (c + x * (x - 1.));
      const Doubles slope = greater(c + x * (3. * x - 2.), same(0));
      const Doubles bend = value * (6. * x - 2.);
      const Doubles radicand = greater(2. * (2. * slope * slope + 3. * bend), same(0));
      const Doubles step = 3. * value / greater(slope + root(radicand), same(1e-30));
      x = greater(x + step, same(0));
    }
    return x > 1. / 3 ? same(1. / 3) : x;
  }

  static inline Vector longer(const Vector& a, const Vector& b) {
    const auto a_is = a.dot(a) >= b.dot(b);
    return {a_is ? a.x : b.x, a_is ? a.y : b.y, a_is ? a.z : b.z};
  }

  // The direction that all rows of the singular matrix c - value are normal to: the longest of
  // their cross products, or zero if the rows are parallel.
  static Vector null_direction(const Symmetric& c, const Doubles& value) {
    const Vector a{c.xx - value, c.xy, c.xz};
    const Vector b{c.xy, c.yy - value, c.yz};
    const Vector e{c.xz, c.yz, c.zz - value};
    const Vector v = longer(longer(a.cross(b), b.cross(e)), e.cross(a));
    const Doubles squared = v.dot(v);
    const Doubles scale = 1. / root(greater(squared, same(1e-300)));
    const Doubles defined = squared > 1e-24 ? scale : Doubles{};
    return {v.x * defined, v.y * defined, v.z * defined};
  }

  static void fit(const Row* moments, Planes* planes) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      Doubles trace;
      const Symmetric c = covariance(moments, q, trace);
      const Doubles minors =
          c.xx * c.yy - c.xy * c.xy + (c.xx * c.zz - c.xz * c.xz) + (c.yy * c.zz - c.yz * c.yz);
      const Doubles determinant = c.xx * (c.yy * c.zz - c.yz * c.yz) -
                                  c.xy * (c.xy * c.zz - c.yz * c.xz) +
                                  c.xz * (c.xy * c.yz - c.yy * c.xz);
      const Doubles smallest = smallest_root(minors, determinant);
      // The other two from their sum and product.
      const Doubles half_sum = 0.5 * (1. - smallest);
      const Doubles product = minors - smallest * (1. - smallest);
      const Doubles half_gap = root(greater(half_sum * half_sum - product, same(0)));
      const Vector normal = null_direction(c, smallest);
      store(planes->normal_x + q, normal.x);
      store(planes->normal_y + q, normal.y);
      store(planes->normal_z + q, normal.z);
      store(planes->smallest + q, trace * smallest);
      store(planes->middle + q, trace * greater(half_sum - half_gap, smallest));
      store(planes->largest + q, trace * (half_sum + half_gap));
    }
  }
};

}  // namespace
}  // namespace palpate::simd
