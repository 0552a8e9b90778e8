// The sums that are made several points at once, at each level of the instruction set, against
// loops over one point after the other.
#include "field/simd/sums.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/cpu.hpp"
#include "field/formulas.hpp"
#include "field/random_patch.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::RandomPatch;

Vector3d at(const double* const column[3], std::uint32_t i) {
  return {column[0][i], column[1][i], column[2][i]};
}

// What the sums need of one point.
struct OnePoint {
  OnePoint(const simd::Columns& c, Kernel kernel, std::uint32_t i, const Vector3d& x)
      : q(at(c.position, i) - x),
        n(at(c.normal, i)),
        radius(c.radius[i]),
        confidence(c.confidence[i]) {
    const KernelValue value = evaluate(kernel, q.squaredNorm() * c.inverse_r2[i]);
    w = c.weight[i] * value.w;
    slope = -c.weight[i] * value.g * c.inverse_r2[i];
  }
  Vector3d q, n;
  double radius, confidence, w, slope;
};

// What the header says of the sums, in the order of Sums.
std::vector<double> plain_sums(const simd::Columns& c, Kernel kernel, const Vector3d& x, bool all) {
  std::vector<double> sums;
  const auto put = [&](const Vector3d& v) { sums.insert(sums.end(), v.begin(), v.end()); };
  for (int source = 0; source < c.sources; ++source) {
    double w = 0, wr = 0;
    Vector3d grad_w = Vector3d::Zero(), grad_wr = Vector3d::Zero();
    for (int run = source; run < c.labels * c.sources; run += c.sources) {
      for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; ++i) {
        const OnePoint p(c, kernel, i, x);
        w += p.w;
        wr += p.w * p.radius;
        grad_w += p.slope * p.q;
        grad_wr += p.slope * p.radius * p.q;
      }
    }
    sums.insert(sums.end(), {w, wr});
    put(grad_w);
    put(grad_wr);
  }
  for (int run = 0; all && run < c.labels * c.sources; ++run) {
    double v = 0, vnq = 0;
    Vector3d vq = Vector3d::Zero(), vn = Vector3d::Zero(), grad_v = Vector3d::Zero();
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; ++i) {
      const OnePoint p(c, kernel, i, x);
      const double vi = p.w * p.confidence;
      v += vi;
      vnq += vi * p.n.dot(p.q);
      vq += vi * p.q;
      vn += vi * p.n;
      grad_v += p.slope * p.confidence * p.q;
    }
    sums.insert(sums.end(), {v, vnq});
    put(vn);
    put(vq);
    put(grad_v);
  }
  return sums;
}

// The same of what a level gave.
std::vector<double> sums_of(const simd::Columns& c, const simd::Sums& given, bool all) {
  std::vector<double> sums;
  const auto put = [&](const double v[3]) { sums.insert(sums.end(), v, v + 3); };
  for (int s = 0; s < c.sources; ++s) {
    sums.insert(sums.end(), {given.w[s], given.wr_of[s]});
    put(given.grad_w[s]);
    put(given.grad_wr_of[s]);
  }
  for (int run = 0; all && run < c.labels * c.sources; ++run) {
    const simd::LabelSums& label = given.label[run / c.sources];
    const simd::SourceMoments& of = label.of[run % c.sources];
    sums.insert(sums.end(), {of.v, of.vnq});
    put(of.vn);
    put(label.vq);
    put(label.grad_v);
  }
  return sums;
}

// Adds vq and grad_v of a label's runs up, as LabelSums holds them.
void add_up_labels(const simd::Columns& c, std::vector<double>& sums) {
  constexpr std::size_t kOfSource = 8, kOfRun = 11, kLabelFrom = 5;
  const std::size_t first = kOfSource * static_cast<std::size_t>(c.sources);
  for (int label = 0; label < c.labels; ++label) {
    for (std::size_t k = kLabelFrom; k < kOfRun; ++k) {
      double total = 0;
      const auto place = [&](int s) {
        return first + kOfRun * static_cast<std::size_t>(label * c.sources + s) + k;
      };
      for (int s = 0; s < c.sources; ++s) total += sums[place(s)];
      for (int s = 0; s < c.sources; ++s) sums[place(s)] = total;
    }
  }
}

// For each source at most this sum of weights within h of x.
std::vector<double> plain_bounds(const simd::Columns& c, Kernel kernel, const Vector3d& x,
                                 double h) {
  std::vector<double> bounds(static_cast<std::size_t>(c.sources), 0);
  for (int run = 0; run < c.labels * c.sources; ++run) {
    for (std::uint32_t i = c.run_begin[run]; i < c.run_begin[run + 1]; ++i) {
      const double nearest = std::max(0.0, (at(c.position, i) - x).norm() - h);
      bounds[static_cast<std::size_t>(run % c.sources)] +=
          c.weight[i] * evaluate(kernel, nearest * nearest * c.inverse_r2[i]).w;
    }
  }
  return bounds;
}

Vector3d plain_gradient(const simd::Columns& c, Kernel kernel, const Vector3d& x,
                        const simd::Linear& b) {
  Vector3d total = Vector3d::Zero();
  for (std::uint32_t i = 0; i < c.end(); ++i) {
    const OnePoint p(c, kernel, i, x);
    const double bi =
        p.n.dot(Vector3d(b.alpha)) + p.q.dot(Vector3d(b.beta)) + p.n.dot(p.q) * b.gamma + b.delta;
    total += p.slope * p.confidence * bi * p.q;
  }
  return total;
}

// v, its gradient, v h, its gradient (docs/method.md 2.8).
std::vector<double> plain_edges(const simd::Columns& c, Kernel kernel, const Vector3d& x) {
  double v = 0, vh = 0;
  Vector3d grad_v = Vector3d::Zero(), grad_vh = Vector3d::Zero();
  for (std::uint32_t i = 0; i < c.end(); ++i) {
    const OnePoint p(c, kernel, i, x);
    const double share = std::abs(c.edge_share[i]);
    const double sign = c.edge_share[i] < 0 ? -1 : 1;
    const double width = (sign < 0 ? 0.05 : 0.005) * p.radius;
    const Vector3d m = at(c.edge_normal, i);
    const double h = -sign * p.n.dot(p.q);
    const double k = sign * (c.edge_height[i] - m.dot(p.q));
    const double rounding = std::max(0.0, width - std::abs(k - h));
    const double height = sign * (std::max(h, k) + rounding * rounding / (4 * width));
    const double of_k = std::clamp((k - h) / width, -1.0, 1.0) / 2 + 0.5;
    const double vi = p.w * p.confidence * share;
    const Vector3d slope = p.slope * p.confidence * share * p.q;
    v += vi;
    vh += vi * height;
    grad_v += slope;
    grad_vh += slope * height + vi * ((1 - of_k) * p.n + of_k * m);
  }
  return {v, grad_v[0], grad_v[1], grad_v[2], vh, grad_vh[0], grad_vh[1], grad_vh[2]};
}

void expect_near(const std::vector<double>& given, const std::vector<double>& plain, const char* of,
                 double error = 1e-12) {
  ASSERT_EQ(given.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(given[i], plain[i], error) << of << ", number " << i;
  }
}

class SumsAtEachLevel : public testing::TestWithParam<const simd::Functions*> {
 protected:
  void SetUp() override {
    if (GetParam() == &simd::kSumsV3 && !cpu_has_v3()) GTEST_SKIP() << "no x86-64-v3 here";
  }

  void compare(RandomPatch& patch, Kernel kernel) {
    const simd::Columns& c = patch.columns();
    const simd::Functions& functions = *GetParam();
    const bool wendland = kernel == Kernel::wendland;
    const Vector3d x = patch.draw3(0.4);
    simd::Sums sums{};
    functions.weights(c, wendland, x.data(), sums);
    expect_near(sums_of(c, sums, false), plain_sums(c, kernel, x, false), "weights");
    functions.all(c, wendland, x.data(), sums);
    std::vector<double> plain = plain_sums(c, kernel, x, true);
    add_up_labels(c, plain);
    expect_near(sums_of(c, sums, true), plain, "all");
    const std::uint32_t end = sums.near_begin[c.labels * c.sources];

    const simd::Linear linear{{1, 2, 3}, {0.1, -0.2, 0.3}, 0.4, -0.5};
    Vector3d gradient;
    functions.gradient(c, 0, end, x.data(), linear, gradient.data());
    EXPECT_LT((gradient - plain_gradient(c, kernel, x, linear)).norm(), 1e-12) << "gradient";

    std::array<double, simd::kMaxSources> bounds{};
    functions.bound(c, wendland, x.data(), 0.2, bounds.data());
    expect_near({bounds[0], bounds[1]}, plain_bounds(c, kernel, x, 0.2), "bound");

    simd::EdgeSums edges{};
    functions.edges(c, 0, end, wendland, x.data(), edges);
    const double *v = edges.grad_v, *vh = edges.grad_vh;
    // The width is larger by 1e-12 m here, against points without a radius.
    expect_near({edges.v, v[0], v[1], v[2], edges.vh, vh[0], vh[1], vh[2]},
                plain_edges(c, kernel, x), "edges", 1e-9);
  }
};

TEST_P(SumsAtEachLevel, AreThoseOfOnePointAfterTheOther) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    for (const bool even : {true, false}) {
      RandomPatch patch(seed, even);
      compare(patch, Kernel::wyvill);
      compare(patch, Kernel::wendland);
      if (HasFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, SumsAtEachLevel,
                         testing::Values(&simd::kSumsBaseline, &simd::kSumsV3),
                         [](const auto& level) { return level.index == 0 ? "Baseline" : "V3"; });

TEST(Sums, HaveTheSameBitsAtEachLevel) {
  if (!cpu_has_v3()) GTEST_SKIP() << "no x86-64-v3 here";
  for (unsigned seed = 1; seed <= 50; ++seed) {
    RandomPatch patch(seed, seed % 2 == 0);
    const Vector3d x = patch.draw3(0.4);
    simd::Sums baseline{}, v3{};
    simd::kSumsBaseline.all(patch.columns(), seed % 3 == 0, x.data(), baseline);
    simd::kSumsV3.all(patch.columns(), seed % 3 == 0, x.data(), v3);
    EXPECT_EQ(std::memcmp(&baseline, &v3, sizeof v3), 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace palpate
