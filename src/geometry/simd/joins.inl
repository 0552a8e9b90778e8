// The body of both copies of the joins. Everything in it has internal linkage.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

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

template <std::size_t kLanes>
struct Joins {
  static_assert(kQueries % kLanes == 0);
  typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
  typedef std::int32_t Mask __attribute__((vector_size(kLanes * sizeof(float))));

  static inline Floats load(const float* from) {
    Floats v;
    std::memcpy(&v, from, sizeof v);
    return v;
  }
  static inline void store(float* to, const Floats& v) { std::memcpy(to, &v, sizeof v); }
  static inline Floats keep(const Mask& mask, const Floats& v) { return (Floats)(mask & (Mask)v); }

  static inline Mask same(std::int32_t value) { return value - Mask{}; }

  struct Offset {
    Floats x, y, z;
    Floats squared() const { return x * x + y * y + z * z; }
  };

  // Calls visit(offset, candidate) for all candidates, offsets from the queries [query, + kLanes).
  template <class Visit>
  static inline void each(const Join& join, std::size_t query, const Visit& visit) {
    const Floats x = load(join.x + query);
    const Floats y = load(join.y + query);
    const Floats z = load(join.z + query);
    for (std::size_t r = 0; r < join.run_count; ++r) {
      for (std::size_t c = join.runs[r].begin; c < join.runs[r].end; ++c) {
        visit(Offset{join.x[c] - x, join.y[c] - y, join.z[c] - z}, c);
      }
    }
  }

  static void moments(const Join& join, const float* squared_radii, Row* rows) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      const Floats squared_radius = load(squared_radii + join.query + q);
      const Floats one = Floats{} + 1.f;
      Floats n{}, x{}, y{}, z{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
      each(join, join.query + q, [&](const Offset& offset, std::size_t) {
        const Mask near = offset.squared() <= squared_radius;
        const Offset d{keep(near, offset.x), keep(near, offset.y), keep(near, offset.z)};
        n += keep(near, one);
        x += d.x;
        y += d.y;
        z += d.z;
        xx += d.x * d.x;
        xy += d.x * d.y;
        xz += d.x * d.z;
        yy += d.y * d.y;
        yz += d.y * d.z;
        zz += d.z * d.z;
      });
      const Floats sums[kMoments] = {n, x, y, z, xx, xy, xz, yy, yz, zz};
      for (std::size_t k = 0; k < kMoments; ++k) store(rows[k] + q, sums[k]);
    }
  }

  static inline Floats gap(float lower_a, float upper_a, const Floats& lower, const Floats& upper) {
    const Floats below = lower - upper_a;
    const Floats above = lower_a - upper;
    const Floats outside = below < above ? above : below;
    return keep(outside > 0.f, outside);
  }

  static std::size_t near(const Leaves& leaves, const float* lower, const float* upper,
                          float squared_radius, Run* runs) {
    constexpr std::uint32_t kNowhere = ~0u;
    Run open{kNowhere, kNowhere};
    std::size_t count = 0;
    for (std::size_t first = 0; first < leaves.count; first += kLanes) {
      Floats squared{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats d = gap(lower[axis], upper[axis], load(leaves.lower[axis] + first),
                             load(leaves.upper[axis] + first));
        squared += d * d;
      }
      const Mask mask =
          (squared <= squared_radius) | (squared <= load(leaves.squared_reach + first));
      std::int32_t hits[kLanes];
      std::memcpy(hits, &mask, sizeof mask);
      // No branches: whether a leaf is near cannot be foretold.
      for (std::size_t l = 0; l < kLanes; ++l) {
        const Run leaf = leaves.points[first + l];
        const auto hit = static_cast<std::uint32_t>(hits[l]);
        const std::uint32_t fresh = hit & (0u - static_cast<std::uint32_t>(leaf.begin != open.end));
        runs[count] = open;
        count += fresh & 1;
        open.begin ^= (open.begin ^ leaf.begin) & fresh;
        open.end ^= (open.end ^ leaf.end) & hit;
      }
    }
    runs[count] = open;
    return count;
  }

  // Squared distances are never negative: as bit patterns they have the same order, and integers
  // have a minimum and a maximum in one instruction each.
  template <std::size_t kSlots, bool kApart>
  static void nearest(const Join& join, Row* rows) {
    const Mask infinite = same(std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity()));
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      Mask slots[kSlots];
      for (Mask& slot : slots) slot = infinite;
      each(join, join.query + q, [&](const Offset& offset, std::size_t) {
        Mask d = (Mask)offset.squared();
        if constexpr (kApart) d = d > 0 ? d : infinite;
        for (Mask& slot : slots) {
          const Mask lower = d < slot ? d : slot;
          d = d < slot ? slot : d;
          slot = lower;
        }
      });
      for (std::size_t k = 0; k < kSlots; ++k) store(rows[k] + q, (Floats)slots[k]);
    }
  }

  // Eq. (1) and eq. (2) of q = r^2.
  struct Wyvill {
    static inline Floats weight(const Floats& q) {
      return keep(q < 1.f, 1.f + q * (float(-22. / 9) + q * (float(17. / 9) - q * float(4. / 9))));
    }
  };
  struct Wendland {
    static inline Floats weight(const Floats& q) {
      float roots[kLanes];
      store(roots, q);
      for (float& root : roots) root = std::sqrt(root);
      const Floats r = load(roots);
      const Floats s = 1.f - r;
      return keep(q < 1.f, s * s * s * s * (4.f * r + 1.f));
    }
  };

  template <class Kernel>
  static void sums(const Join& join, const float* inverse, const float* values, Row* sum) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      Floats total{};
      each(join, join.query + q, [&](const Offset& offset, std::size_t c) {
        total += Kernel::weight(offset.squared() * inverse[c]) * values[c];
      });
      store(*sum + q, total);
    }
  }

  static void pairs(const Join& join, const float* inverse, const float* first, const float* second,
                    Row* sums) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      const Floats scale = load(inverse + join.query + q);
      Floats a{}, b{};
      each(join, join.query + q, [&](const Offset& offset, std::size_t c) {
        const Floats r2 = offset.squared() * scale;
        const Floats w = keep(r2 > 0.f, Wyvill::weight(r2));
        a += w * first[c];
        b += w * second[c];
      });
      store(sums[0] + q, a);
      store(sums[1] + q, b);
    }
  }

  static constexpr JoinFunctions functions() {
    return {&near,
            &moments,
            &PlaneFits<kLanes / 2>::fit,
            &nearest<4, false>,
            &nearest<8, true>,
            &sums<Wyvill>,
            &sums<Wendland>,
            &pairs};
  }
};

}  // namespace
}  // namespace palpate::simd
