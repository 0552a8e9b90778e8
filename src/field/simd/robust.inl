// Sums in which points of another direction count for less (robust.inl follows sums.inl): what a
// surface with sharp edges is made of. Included, as that, by one source file for each level.

#include "field/simd/sums.hpp"

namespace palpate::simd {
namespace {

// exp(z) for z in [-16, 0], for smaller z that of -16; within 1e-11 of the true value. The Taylor
// polynomial of exp(z / 32) around z = -8, and then five squarings: the same bits on every level.
inline Lanes decay(const Lanes& z) {
  constexpr double kLowest = -16;
  const Lanes above = z - kLowest;
  const Lanes t = (0.5 * (above + stdx::abs(above)) + (kLowest + 8)) * (1. / 32);
  Lanes sum = 1. / 362880;
  for (const double inverse_factorial :
       {1. / 40320, 1. / 5040, 1. / 720, 1. / 120, 1. / 24, 1. / 6, 1. / 2, 1., 1.}) {
    sum = sum * t + inverse_factorial;
  }
  sum *= 0.77880078307140486825;  // exp(-1 / 4)
  for (int i = 0; i < 5; ++i) sum *= sum;
  return sum;
}

template <bool kWendland>
std::uint32_t near(const Columns& c, std::uint32_t begin, std::uint32_t end,
                   const double x[3]) noexcept {
  std::uint32_t places = 0;
  for (std::uint32_t i = begin; i < end; i += kLanes) {
    const Vector q = offsets(c, i, x);
    const Lanes w = load(c.weight + i) * kernel<kWendland>(dot(q, q) * load(c.inverse_r2 + i)).w;
    const Lanes v = kScaleW<kWendland> * (w * load(c.confidence + i));
    if (!(sum(v) > 0)) continue;
    v.copy_to(c.trusted + i, stdx::element_aligned);
    c.near[places++] = i;
  }
  return places;
}

std::uint32_t near_of(const Columns& c, std::uint32_t begin, std::uint32_t end, bool wendland,
                      const double x[3]) noexcept {
  return wendland ? near<true>(c, begin, end, x) : near<false>(c, begin, end, x);
}

void share(const Columns& c, std::uint32_t places, const double x[3], Share& out) noexcept {
  Lanes sv = 0;
  Vector grad;
  for (std::uint32_t k = 0; k < places; ++k) {
    const std::uint32_t i = c.near[k];
    const Lanes sharp = load(c.sharp + i);
    sv += sharp * load(c.trusted + i);
    add(grad, sharp * load(c.slope + i) * load(c.confidence + i), offsets(c, i, x));
  }
  out.sv = sum(sv);
  store(grad, 1, out.grad_sv);
}

void robust(const Columns& c, std::uint32_t places, const double x[3], const double mean[3], int k,
            Moments& out) noexcept {
  constexpr double kFactor = -1 / (kSpread * kSpread);
  Lanes v = 0;
  Lanes vnq = 0;
  Vector vq;
  Vector vn;
  for (std::uint32_t place = 0; place < places; ++place) {
    const std::uint32_t i = c.near[place];
    const Vector n = load3(c.normal, i);
    const Vector q = offsets(c, i, x);
    const Vector turn{n.x - mean[0], n.y - mean[1], n.z - mean[2]};
    const Lanes phi = decay(kFactor * dot(turn, turn));
    phi.copy_to(c.closeness[k] + i, stdx::element_aligned);
    const Lanes vi = load(c.trusted + i) * phi;
    v += vi;
    vnq += vi * dot(n, q);
    add(vq, vi, q);
    add(vn, vi, n);
  }
  out.v = sum(v);
  out.vnq = sum(vnq);
  store(vq, 1, out.vq);
  store(vn, 1, out.vn);
}

void pull(const Columns& c, std::uint32_t places, const double x[3], const double mean[3], int k,
          const Linear& b, Pull& out) noexcept {
  const Vector alpha{b.alpha[0], b.alpha[1], b.alpha[2]};
  const Vector beta{b.beta[0], b.beta[1], b.beta[2]};
  Vector of_place;
  Vector of_normal;
  for (std::uint32_t place = 0; place < places; ++place) {
    const std::uint32_t i = c.near[place];
    const Vector n = load3(c.normal, i);
    const Vector q = offsets(c, i, x);
    const Vector turn{n.x - mean[0], n.y - mean[1], n.z - mean[2]};
    const Lanes bi = dot(n, alpha) + dot(q, beta) + dot(n, q) * b.gamma + b.delta;
    const Lanes weighed = load(c.closeness[k] + i) * bi;
    add(of_place, load(c.slope + i) * load(c.confidence + i) * weighed, q);
    add(of_normal, load(c.trusted + i) * weighed, turn);
  }
  store(of_place, 1, out.place);
  store(of_normal, 2 / (kSpread * kSpread), out.normal);
}

}  // namespace
}  // namespace palpate::simd
