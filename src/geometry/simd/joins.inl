// The body of both copies of the joins. Everything in it has internal linkage.
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/simd/joins.hpp"

namespace palpate::simd {
namespace {

template <std::size_t kLanes>
struct Joins {
  static_assert(kQueryStep % kLanes == 0);
  typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));
  typedef std::int32_t Mask __attribute__((vector_size(kLanes * sizeof(float))));

  static inline Floats load(const float* from) {
    Floats v;
    std::memcpy(&v, from, sizeof v);
    return v;
  }
  static inline void store(float* to, const Floats& v) { std::memcpy(to, &v, sizeof v); }
  static inline Floats keep(const Mask& mask, const Floats& v) { return (Floats)(mask & (Mask)v); }
  static inline Floats less(const Floats& a, const Floats& b) { return a < b ? a : b; }
  static inline Floats more(const Floats& a, const Floats& b) { return a < b ? b : a; }

  struct Offsets {
    Floats x, y, z;
    Floats squared() const { return x * x + y * y + z * z; }
  };

  struct Queries {
    Floats x, y, z;
    Queries(const Coordinates& from, std::size_t q)
        : x(load(from.x + q)), y(load(from.y + q)), z(load(from.z + q)) {}
    Offsets to(const Coordinates& candidates, std::size_t c) const {
      return {candidates.x[c] - x, candidates.y[c] - y, candidates.z[c] - z};
    }
  };

  static void moments(const Coordinates& queries, const float* squared_radii,
                      const Coordinates& candidates, float* const* rows) {
    for (std::size_t q = 0; q < queries.count; q += kLanes) {
      const Queries from(queries, q);
      const Floats squared_radius = load(squared_radii + q);
      const Floats one = Floats{} + 1.f;
      Floats n{}, x{}, y{}, z{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
      for (std::size_t c = 0; c < candidates.count; ++c) {
        Offsets d = from.to(candidates, c);
        const Mask near = d.squared() <= squared_radius;
        d = {keep(near, d.x), keep(near, d.y), keep(near, d.z)};
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
      }
      const Floats sums[kMoments] = {n, x, y, z, xx, xy, xz, yy, yz, zz};
      for (std::size_t k = 0; k < kMoments; ++k) store(rows[k] + q, sums[k]);
    }
  }

  template <std::size_t kSlots, bool kApart>
  static void nearest(const Coordinates& queries, const Coordinates& candidates,
                      float* const* rows) {
    const Floats infinite = Floats{} + std::numeric_limits<float>::infinity();
    for (std::size_t q = 0; q < queries.count; q += kLanes) {
      const Queries from(queries, q);
      Floats slots[kSlots];
      for (Floats& slot : slots) slot = infinite;
      for (std::size_t c = 0; c < candidates.count; ++c) {
        Floats d = from.to(candidates, c).squared();
        if constexpr (kApart) d = d > 0 ? d : infinite;
        for (Floats& slot : slots) {
          const Floats lower = less(d, slot);
          d = more(d, slot);
          slot = lower;
        }
      }
      for (std::size_t k = 0; k < kSlots; ++k) store(rows[k] + q, slots[k]);
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
  static void sums(const Coordinates& queries, const Coordinates& candidates, const float* inverse,
                   const float* values, float* sums) {
    for (std::size_t q = 0; q < queries.count; q += kLanes) {
      const Queries from(queries, q);
      Floats sum{};
      for (std::size_t c = 0; c < candidates.count; ++c) {
        sum += Kernel::weight(from.to(candidates, c).squared() * inverse[c]) * values[c];
      }
      store(sums + q, sum);
    }
  }

  static void means(const Coordinates& queries, const float* inverse, const Coordinates& candidates,
                    const float* const* values, float* const* sums) {
    for (std::size_t q = 0; q < queries.count; q += kLanes) {
      const Queries from(queries, q);
      const Floats scale = load(inverse + q);
      Floats first{}, second{};
      for (std::size_t c = 0; c < candidates.count; ++c) {
        const Floats r2 = from.to(candidates, c).squared() * scale;
        const Floats w = keep(r2 > 0.f, Wyvill::weight(r2));
        first += w * values[0][c];
        second += w * values[1][c];
      }
      store(sums[0] + q, first);
      store(sums[1] + q, second);
    }
  }

  static constexpr JoinFunctions functions() {
    return {&moments,      &nearest<4, false>, &nearest<8, true>,
            &sums<Wyvill>, &sums<Wendland>,    &means};
  }
};

}  // namespace
}  // namespace palpate::simd
