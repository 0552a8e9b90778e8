// The body of both copies of the joins. Everything in it has internal linkage.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/cpu.hpp"
#include "geometry/simd/joins.hpp"
#include "geometry/simd/planes.inl"

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

  // The points [first, + kLanes); behind the last query point it stands again.
  struct Queries {
    Floats x, y, z;
    Queries(const Join& join, std::size_t first) {
      float numbers[3][kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) {
        const std::size_t behind = join.query + join.count - 1;
        const float* point = join.points + 3 * (first + l < behind ? first + l : behind);
        for (std::size_t axis = 0; axis < 3; ++axis) numbers[axis][l] = point[axis];
      }
      x = load(numbers[0]);
      y = load(numbers[1]);
      z = load(numbers[2]);
    }
    Offset to(const float* point) const { return {point[0] - x, point[1] - y, point[2] - z}; }
  };

  // Calls visit(offset, candidate) for all candidates, offsets from the queries [query, + kLanes).
  template <class Visit>
  static inline void each(const Join& join, std::size_t query, const Visit& visit) {
    const Queries queries(join, query);
    for (std::size_t k = 0; k < join.candidate_count; ++k) {
      const std::size_t c = join.candidates[k];
      visit(queries.to(join.points + 3 * c), c);
    }
  }

  static inline std::uint32_t bits(const Mask& mask, const Mask& bit_of_lane) {
    const Mask own = mask & bit_of_lane;
    std::uint64_t pairs[kLanes / 2];
    std::memcpy(pairs, &own, sizeof own);
    std::uint64_t all = 0;
    for (const std::uint64_t pair : pairs) all |= pair;
    return static_cast<std::uint32_t>(all | all >> 32);
  }

  static constexpr std::size_t kGroups = kQueries / kLanes;  // derived: registers for all queries

  static inline std::array<Queries, kGroups> all_queries(const Join& join) {
    return [&]<std::size_t... kGroup>(std::index_sequence<kGroup...>) {
      return std::array<Queries, kGroups>{Queries(join, join.query + kGroup * kLanes)...};
    }
    (std::make_index_sequence<kGroups>());
  }

  static std::size_t gather(const Join& join, const Search& search, std::uint32_t* found) {
    const std::array<Queries, kGroups> queries = all_queries(join);
    std::size_t count = 0;
    for (std::size_t r = 0; r < search.run_count; ++r) {
      for (std::size_t c = search.runs[r].begin; c < search.runs[r].end; ++c) {
        const float own = search.squared_own == nullptr ? -1.f : search.squared_own[c];
        Mask near{};
        for (std::size_t g = 0; g < kGroups; ++g) {
          const Floats squared = queries[g].to(join.points + 3 * c).squared();
          near |= (squared <= load(search.squared_reaches + g * kLanes)) | (squared <= own);
        }
        found[count] = static_cast<std::uint32_t>(c);  // no branch: hits are random
        count += bits(near, near) != 0;
      }
    }
    return count;
  }

  // The candidates for which near(q, offset, candidate) is true of a lane of [q, q + kLanes).
  template <class Near>
  static inline std::size_t find_hits(const Join& join, Hit* hits, const Near& near) {
    std::size_t count = 0;
    Mask bit_of_lane[kGroups];
    for (std::size_t g = 0; g < kGroups; ++g) {
      std::int32_t bits_of_group[kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) bits_of_group[l] = 1 << (g * kLanes + l);
      std::memcpy(&bit_of_lane[g], bits_of_group, sizeof bits_of_group);
    }
    const std::array<Queries, kGroups> queries = all_queries(join);
    const std::uint32_t used = (1u << join.count) - 1;
    for (std::size_t k = 0; k < join.candidate_count; ++k) {
      const std::size_t c = join.candidates[k];
      std::uint32_t lanes = 0;
      for (std::size_t g = 0; g < kGroups; ++g) {
        const Offset offset = queries[g].to(join.points + 3 * c);
        lanes |= bits(near(g * kLanes, offset, c), bit_of_lane[g]);
      }
      hits[count] = {static_cast<std::uint32_t>(c), lanes & used};
      count += (lanes & used) != 0;
    }
    return count;
  }

  static std::size_t within(const Join& join, const float* squared_radii, Hit* hits) {
    return find_hits(join, hits, [squared_radii](std::size_t q, const Offset& d, std::size_t) {
      return d.squared() <= load(squared_radii + q);
    });
  }

  static std::size_t apart(const Join& join, const Eyes& eyes, Hit* hits) {
    return find_hits(join, hits, [&eyes](std::size_t q, const Offset& d, std::size_t c) {
      const Floats height = load(eyes.normal[0] + q) * d.x +
                            (load(eyes.normal[1] + q) * d.y + load(eyes.normal[2] + q) * d.z);
      const Floats squared = d.x * d.x + (d.y * d.y + d.z * d.z);
      const Floats level = height * height;
      const Floats aside = squared - level;
      const Mask off = ((height < 0.f ? -height : height) > load(eyes.least + q)) &
                       (aside <= load(eyes.squared_tube + q)) &
                       (level >= eyes.squared_slope * aside);
      Mask segment;
      std::memcpy(&segment, eyes.segment + q, sizeof segment);
      const Mask other = (squared <= load(eyes.squared_vote + q)) &
                         (segment != same(static_cast<std::int32_t>(eyes.segments[c])));
      return (d.squared() <= load(eyes.squared_reach + q)) & (off | other);
    });
  }

  static void moments(const Join& join, const float* squared_radii, Row* rows) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      const Floats squared_radius = load(squared_radii + q);
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
    constexpr std::uint32_t kNowhere = ~0u;  // no leaf begins there
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
    const auto add_up = [&](const auto& value) {
      for (std::size_t q = 0; q < kQueries; q += kLanes) {
        Floats total{};
        each(join, join.query + q, [&](const Offset& offset, std::size_t c) {
          total += Kernel::weight(offset.squared() * inverse[c]) * value(c);
        });
        store(*sum + q, total);
      }
    };
    if (values == nullptr) {
      add_up([](std::size_t) { return 1.f; });
    } else {
      add_up([values](std::size_t c) { return values[c]; });
    }
  }

  static void means(const Join& join, const float* inverse, const float* values, Row* sums) {
    for (std::size_t q = 0; q < kQueries; q += kLanes) {
      const Floats scale = load(inverse + q);
      Floats weights{}, total{};
      each(join, join.query + q, [&](const Offset& offset, std::size_t c) {
        const Floats r2 = offset.squared() * scale;
        const Floats w = keep(r2 > 0.f, Wyvill::weight(r2));
        weights += w;
        total += w * values[c];
      });
      store(sums[0] + q, weights);
      store(sums[1] + q, total);
    }
  }

  static constexpr JoinFunctions functions() {
    return {&near,
            &gather,
            &within,
            &apart,
            &moments,
            &PlaneFits<kLanes / 2>::fit,
            &nearest<4, false>,
            &nearest<8, true>,
            &sums<Wyvill>,
            &sums<Wendland>,
            &means};
  }
};

}  // namespace
}  // namespace palpate::simd
