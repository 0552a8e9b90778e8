// Evaluates a field and its gradient from the points of a patch: support, cap, trust and tool.

#include "field/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "field/formulas.hpp"
#include "field/oriented.hpp"

// Notation as in docs/method.md: q_i = p_i - x, w_i the weights, v_i = c_i w_i,
// A = sum v q / sum v, Nb = sum v n / sum v, W the united support, R(x) = sum w R / sum w.

namespace palpate {
namespace {

using Eigen::Vector3d;

// Weight sums up to this count as 0 (judgement): at the rim of a support ratios of sums mean
// nothing.
constexpr double kNoWeight = 1e-12;
// Share of all weight: normals with less are ignored; judgement.
constexpr double kFaintNormals = 1e-9;
// Share of all normals' weight: a label with less is ignored; judgement.
constexpr double kFaintLabel = 1e-6;

// The highest above a plane that a metaball's surface may lie, in support radii (judgement,
// docs/method.md 2.3): farther out the weights are too flat to find it.
constexpr double kHighest = 0.85;

/// W and R(x), and the plain sum of weights that they follow from.
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

/// sum v over labels.
Value trusted(const simd::Sums& sums, int labels) noexcept {
  Value v;
  for (int k = 0; k < labels; ++k) {
    v.f += sums.label[k].v;
    v.grad += vector(sums.label[k].grad_v);
  }
  return v;
}

/// kappa = u^2 (3 - 2u) of u = clamp((chi - 0.25) / 0.3, 0, 1), chi = sum w c / sum w.
Value trust_of(const Value& v, const Support& support) noexcept {
  constexpr double kFrom = 0.25;  // share of the weight; judgement (docs/method.md 2.5)
  constexpr double kWidth = 0.3;  // of the blend, in the same share; judgement
  const double chi = v.f / support.plain;
  const SmoothStep kappa = smooth_step(chi, kFrom, kWidth);
  const Vector3d grad_chi = (v.grad - chi * support.plain_grad) / support.plain;
  return {kappa.value, kappa.slope * grad_chi};
}

/// Eq. (4) to the letter: its vectors carry w where the derivative has w'.
Vector3d printed_gradient(const ImplicitSurface& surface, const simd::Columns& c,
                          const Vector3d& x) noexcept {
  Vector3d total = Vector3d::Zero();
  for (std::uint32_t i = 0; i < c.end(); ++i) {
    const Vector3d away = x - Vector3d(c.position[0][i], c.position[1][i], c.position[2][i]);
    const double r2 = away.squaredNorm();
    if (r2 <= 0) continue;
    const double w = evaluate(surface.options.kernel, r2 * c.inverse_r2[i]).w;
    total -= c.weight[i] * w * away / std::sqrt(r2);
  }
  return total;
}

/// The value where no point weighs, m: that of the cap there, c R Wmin = 0.35 R (docs/method.md
/// 2.5), with no gradient, so that nobody looks for a surface.
double free_value(double radius) noexcept {
  return 0.35 * radius;
}

Sample nothing_here(const Patch& patch) noexcept {
  Sample sample;
  sample.radius = patch.columns().mean_radius;
  sample.value = free_value(sample.radius);
  return sample;
}

/// Cap, tool and blend around the normals' surface (docs/method.md 2.5). `v`: what is trusted.
Value capped(const ImplicitSurface& surface, const Support& support, const Value& height,
             const Value& v) noexcept {
  constexpr double kAtRims = 0.1;  // width of the rounding, R; judgement (docs/method.md 2.5)
  const FieldOptions& options = surface.options;
  const Value outer{height.f - options.tool_radius, height.grad};
  if (!options.capped) return outer;
  const Value floor{options.minimum_support, Vector3d::Zero()};
  const Value cap = smooth_max(outer, as_length(options, support, floor), support.radius, kAtRims);
  const Value trust = trust_of(v, support);
  if (trust.f >= 1) return cap;
  const Value blob = as_length(options, support, level_of(surface, support));
  return {trust.f * cap.f + (1 - trust.f) * blob.f,
          trust.f * cap.grad + (1 - trust.f) * blob.grad + (cap.f - blob.f) * trust.grad};
}

/// Writes the value into the sample: what faces no eye (`averted`) is free (docs/method.md 2.11).
void seen(const Value& value, bool averted, Sample& sample) noexcept {
  sample.averted = averted;
  sample.behind = averted && !(value.f > 0);
  sample.value = sample.behind ? free_value(sample.radius) : value.f;
  if (!sample.behind) sample.gradient = value.grad;
}

}  // namespace

ImplicitSurface::ImplicitSurface(const FieldOptions& given) : sums(&simd::best_sums()) {
  check(given);
  change(given);
}

void ImplicitSurface::change(const FieldOptions& checked) noexcept {
  options = checked;
  offset = options.raw_weights ? 0 : plane_offset(options.kernel, options.threshold);
  largest_tool = std::max(0.0, kHighest - offset);
  const bool metaball = options.kind == FieldOptions::Kind::metaball;
  rise = {options.tool_radius, !metaball ? 0 : options.raw_weights ? kHighest : offset};
}

double united(const double* w, int sources) noexcept {
  if (sources == 1) return w[0];
  double sum = 0;
  for (int s = 0; s < sources; ++s) sum += w[s] * w[s] * w[s] * w[s];
  return std::sqrt(std::sqrt(sum));
}

Sample evaluate(const ImplicitSurface& surface, const Patch& patch, const Vector3d& x) noexcept {
  if (patch.points() == 0) return nothing_here(patch);
  const FieldOptions& options = surface.options;
  const simd::Columns& columns = patch.columns();
  const Vector3d local = x - patch.center();
  const bool wendland = options.kernel == Kernel::wendland;
  const bool metaball = options.kind == FieldOptions::Kind::metaball;
  simd::Sums sums;
  (metaball ? surface.sums->weights : surface.sums->all)(columns, wendland, local.data(), sums);
  const Support support = support_of(sums, columns.sources);
  if (!(support.plain > kNoWeight)) return nothing_here(patch);

  Sample sample;
  sample.support = support.w.f;
  sample.radius = support.radius.f;
  const Value v = metaball ? Value{} : trusted(sums, columns.labels);
  const FieldQuery query{.functions = surface.sums,
                         .columns = &columns,
                         .kernel = options.kernel,
                         .x = local.data(),
                         .all = &sums,
                         .radius = support.radius};
  std::optional<Value> height;
  if (v.f > kFaintNormals * support.plain) {
    height = joined_height(options, query, kFaintLabel * v.f);
  }
  Value value = height ? capped(surface, support, *height, v)
                       : as_length(options, support, level_of(surface, support));
  if (!height && options.gradient == FieldOptions::Gradient::printed) {
    value.grad = printed_gradient(surface, columns, local);
  }
  const std::span weights(sums.w, static_cast<std::size_t>(columns.sources));
  seen(value, !patch.eyes().hold(local, value.grad, weights), sample);
  return sample;
}

double free_level(const ImplicitSurface& surface, double smallest_radius) noexcept {
  const FieldOptions& options = surface.options;
  if (options.kind != FieldOptions::Kind::metaball && !options.capped) return kNoWeight;
  double level = options.threshold;
  if (options.tool_radius > 0) {
    const double tool = std::min(options.tool_radius / smallest_radius, surface.largest_tool);
    level = plane_threshold(options.kernel, surface.offset + tool);
  }
  return options.kind == FieldOptions::Kind::metaball ? level
                                                      : std::min(level, options.minimum_support);
}

bool is_free(const ImplicitSurface& surface, const Patch& patch, const Ball& ball) noexcept {
  if (patch.points() == 0) return true;
  const Vector3d local = ball.center - patch.center();
  double w[simd::kMaxSources];
  surface.sums->bound(patch.columns(), surface.options.kernel == Kernel::wendland, local.data(),
                      ball.radius, w);
  return united(w, patch.columns().sources) < free_level(surface, patch.columns().smallest_radius);
}

}  // namespace palpate
