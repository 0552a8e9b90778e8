// The body of both copies of the joins. Everything in it has internal linkage.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "geometry/simd/joins.hpp"

namespace palpate::simd {
namespace {

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
    return {&moments,      &nearest<4, false>, &nearest<8, true>,
            &sums<Wyvill>, &sums<Wendland>,    &pairs};
  }
};

}  // namespace
}  // namespace palpate::simd
