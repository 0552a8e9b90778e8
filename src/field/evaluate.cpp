#include "field/evaluate.hpp"

#include <algorithm>
#include <cmath>

#include "field/acute_creases.hpp"
#include "field/oriented.hpp"
#include "field/sharp_edges.hpp"
#include "field/smooth_step.hpp"
#include "field/united_height.hpp"

// Notation as in docs/architecture.md: q_i = p_i - x, w_i the weights, v_i = c_i w_i,
// A = sum v q / sum v, Nb = sum v n / sum v, W the united support, R(x) = sum w R / sum w.

namespace palpate {
namespace {

using Eigen::Vector3d;

// Weight sums up to this are none: the rim of a support, where ratios of sums mean nothing.
constexpr double kNoWeight = 1e-12;

// The highest above a plane that a metaball's surface may lie, in support radii: further out
// weights are too flat for it to be found.
constexpr double kHighest = 0.85;

/// W, R(x) and what is at hand of the sums.
struct Support {
  Value w;
  Value radius;
  double plain = 0;  // sum of w_i over all sources
  Vector3d plain_grad = Vector3d::Zero();
};

Value unite(const simd::Sums& sums, int sources) noexcept {
  if (sources == 1) return {sums.w[0], vector(sums.grad_w[0])};
  Value result{united(sums.w, sources), Vector3d::Zero()};
  if (result.f <= 0) return result;
  for (int s = 0; s < sources; ++s) {
    const double share = sums.w[s] / result.f;
    result.grad += share * share * share * vector(sums.grad_w[s]);
  }
  return result;
}

Support support_of(const simd::Sums& sums, int sources) noexcept {
  Support result;
  result.w = unite(sums, sources);
  for (int s = 0; s < sources; ++s) {
    result.plain += sums.w[s];
    result.plain_grad += vector(sums.grad_w[s]);
  }
  const double inverse = 1 / result.plain;
  result.radius.f = sums.wr * inverse;
  result.radius.grad = inverse * (vector(sums.grad_wr) - result.radius.f * result.plain_grad);
  return result;
}

/// 0.35 R / Wmin (level - W): a weight sum as a length.
Value as_length(const FieldOptions& options, const Support& support, const Value& level) noexcept {
  const double c = 0.35 / options.minimum_support;
  const double above = level.f - support.w.f;
  return {c * support.radius.f * above,
          c * (above * support.radius.grad + support.radius.f * (level.grad - support.w.grad))};
}

/// The metaball's level T'; a tool of radius r lowers it so far that a plane moves out by r.
Value level_of(const ImplicitSurface& surface, const Support& support) noexcept {
  const FieldOptions& options = surface.options;
  if (options.tool_radius <= 0) return {options.threshold, Vector3d::Zero()};
  const double tool = options.tool_radius / support.radius.f;
  const double eta = surface.offset + std::min(tool, surface.largest_tool);
  const double slope = plane_threshold_slope(options.kernel, eta);
  const double d_eta = tool < surface.largest_tool ? -tool / support.radius.f : 0;
  return {plane_threshold(options.kernel, eta), slope * d_eta * support.radius.grad};
}

/// Can the normals' surface be told here at all?
bool has_normals(const FieldOptions& options, const simd::Sums& sums, double plain) noexcept {
  if (options.kind == FieldKind::metaball || !(sums.v > 1e-9 * plain)) return false;
  return options.kind == FieldKind::balanced ||
         vector(sums.vn).squaredNorm() > 1e-24 * sums.v * sums.v;
}

/// Smooth maximum of two lengths over a width k = R / 10 that may vary: C1 (algorithm.md 1.4).
Value smooth_max(const Value& a, const Value& b, const Value& radius) noexcept {
  const double k = 0.1 * radius.f;
  const double d = std::abs(a.f - b.f);
  const Value& larger = a.f > b.f ? a : b;
  const Value& smaller = a.f > b.f ? b : a;
  if (d >= k) return larger;
  const double h = (k - d) / k;
  const double by_k = (k - d) * (k + d) / (4 * k * k);
  return {larger.f + 0.25 * h * h * k,
          (1 - 0.5 * h) * larger.grad + 0.5 * h * smaller.grad + by_k * 0.1 * radius.grad};
}

/// kappa = u^2 (3 - 2u) of u = clamp((chi - 0.25) / 0.3, 0, 1), chi = sum w c / sum w.
Value trust_of(const simd::Sums& sums, const Support& support) noexcept {
  constexpr double kFrom = 0.25;
  constexpr double kWidth = 0.3;
  const double chi = sums.v / support.plain;
  const SmoothStep kappa = smooth_step(chi, kFrom, kWidth);
  const Vector3d grad_chi = (vector(sums.grad_v) - chi * support.plain_grad) / support.plain;
  return {kappa.value, kappa.slope * grad_chi};
}

/// Eq. (4) to the letter: its vectors carry w where the derivative has w'.
Vector3d printed_gradient(const ImplicitSurface& surface, const simd::Columns& c,
                          const Vector3d& x) noexcept {
  Vector3d total = Vector3d::Zero();
  for (std::uint32_t i = 0; i < c.source_begin[c.sources]; ++i) {
    const Vector3d away = x - Vector3d(c.position[0][i], c.position[1][i], c.position[2][i]);
    const double r2 = away.squaredNorm();
    if (r2 <= 0) continue;
    const double w = evaluate(surface.options.kernel, r2 * c.inverse_r2[i]).w;
    total -= c.weight[i] * w * away / std::sqrt(r2);
  }
  return total;
}

Sample nothing_here(const Patch& patch) noexcept {
  Sample sample;
  sample.radius = patch.mean_radius();
  sample.value = 0.35 * sample.radius;
  return sample;
}

/// May edges be sharpened here?
bool may_sharpen(const FieldOptions& options, const simd::Columns& columns) noexcept {
  return options.sharp_edges && columns.uniform_sharp != 0 && options.kind == FieldKind::balanced &&
         options.gradient == GradientKind::exact;
}

/// The normals' surface there, signed by the normals, with its exact gradient.
Value height_at(const FieldOptions& options, const FieldPlace& place) noexcept {
  if (may_sharpen(options, *place.columns)) return sharp_balanced(place);
  const Oriented oriented =
      options.kind == FieldKind::balanced ? balanced(*place.sums) : pointset(*place.sums);
  if (options.gradient == GradientKind::normal) return {oriented.f, oriented.base};
  double sum[3];
  place.functions->gradient(*place.columns, place.x, oriented.b, sum);
  return {oriented.f, oriented.base + vector(sum)};
}

/// The same, where several sources may tell of one surface at different heights.
Value united_height_at(const FieldOptions& options, const FieldPlace& place) noexcept {
  const Value height = height_at(options, place);
  if (place.columns->sources == 1 || options.gradient != GradientKind::exact) return height;
  const Value shift = united_shift(place);
  return {height.f + shift.f, height.grad + shift.grad};
}

/// Closed creases, cap, tool and blend around the normals' surface (algorithm.md 1.4, 1.5).
Value capped(const ImplicitSurface& surface, const FieldPlace& place, const Support& support,
             const Value& height) noexcept {
  const FieldOptions& options = surface.options;
  Value outer{place.sign * height.f - options.tool_radius, place.sign * height.grad};
  if (!options.capped) return outer;
  const Value closure = crease_closure(place);
  outer = {outer.f - closure.f, outer.grad - closure.grad};
  const Value floor{options.minimum_support, Vector3d::Zero()};
  const Value cap = smooth_max(outer, as_length(options, support, floor), support.radius);
  const Value trust = trust_of(*place.sums, support);
  if (trust.f >= 1) return cap;
  const Value blob = as_length(options, support, level_of(surface, support));
  return {trust.f * cap.f + (1 - trust.f) * blob.f,
          trust.f * cap.grad + (1 - trust.f) * blob.grad + (cap.f - blob.f) * trust.grad};
}

}  // namespace

ImplicitSurface::ImplicitSurface(const FieldOptions& given) : sums(&simd::best()) {
  check(given);
  change(given);
}

void ImplicitSurface::change(const FieldOptions& checked) noexcept {
  options = checked;
  offset = options.raw_weights ? 0 : plane_offset(options.kernel, options.threshold);
  largest_tool = std::max(0.0, kHighest - offset);
}

double united(const double* w, int sources) noexcept {
  if (sources == 1) return w[0];
  double sum = 0;
  for (int s = 0; s < sources; ++s) sum += w[s] * w[s] * w[s] * w[s];
  return std::sqrt(std::sqrt(sum));
}

Sample evaluate(const ImplicitSurface& surface, const Patch& patch, const Vector3d& x,
                Side side) noexcept {
  if (patch.points() == 0) return nothing_here(patch);
  const FieldOptions& options = surface.options;
  const Vector3d local = x - patch.center();
  const bool wendland = options.kernel == Kernel::wendland;
  simd::Sums sums;
  const auto sum = options.kind == FieldKind::metaball ? surface.sums->weights : surface.sums->all;
  sum(patch.columns(), wendland, local.data(), sums);
  const Support support = support_of(sums, patch.columns().sources);
  if (!(support.plain > kNoWeight)) return nothing_here(patch);

  Sample sample;
  sample.support = support.w.f;
  sample.radius = support.radius.f;
  Value value;
  if (has_normals(options, sums, support.plain)) {
    const FieldPlace place{.functions = surface.sums,
                           .columns = &patch.columns(),
                           .kernel = options.kernel,
                           .x = local.data(),
                           .sums = &sums,
                           .sign = options.two_sided && side < 0 ? -1. : 1.,
                           .radius = support.radius};
    const Value height = united_height_at(options, place);
    sample.height = height.f;
    value = capped(surface, place, support, height);
  } else {
    value = as_length(options, support, level_of(surface, support));
    if (options.gradient == GradientKind::printed) {
      value.grad = printed_gradient(surface, patch.columns(), local);
    }
  }
  sample.value = value.f;
  sample.gradient = value.grad;
  return sample;
}

double free_level(const ImplicitSurface& surface, double smallest_radius) noexcept {
  const FieldOptions& options = surface.options;
  if (options.kind != FieldKind::metaball && !options.capped) return kNoWeight;
  double level = options.threshold;
  if (options.tool_radius > 0) {
    const double tool = std::min(options.tool_radius / smallest_radius, surface.largest_tool);
    level = plane_threshold(options.kernel, surface.offset + tool);
  }
  return options.kind == FieldKind::metaball ? level : std::min(level, options.minimum_support);
}

bool is_free(const ImplicitSurface& surface, const Patch& patch, const Ball& ball) noexcept {
  if (patch.points() == 0) return true;
  const Vector3d local = ball.center - patch.center();
  double w[simd::kMaxSources];
  surface.sums->bound(patch.columns(), surface.options.kernel == Kernel::wendland, local.data(),
                      ball.radius, w);
  return united(w, patch.columns().sources) < free_level(surface, patch.smallest_radius());
}

}  // namespace palpate
