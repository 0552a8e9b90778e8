// What becomes one cluster: what gains the most goes first, and clusters agree as a whole.
#include "refine/signed_graph.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

/// The graph of so many nodes and of the free side, which is the node of that number, contracted.
SignedGraph contracted(std::size_t nodes, const std::vector<SignedEdge>& edges) {
  SignedGraph graph(detail::SignedSets(nodes + 1));
  for (const SignedEdge& edge : edges) graph.add(edge);
  graph.contract();
  return graph;
}

/// The sign of a relative to b; 0: they are not in one cluster.
int sign_of(SignedGraph& graph, std::uint32_t a, std::uint32_t b) {
  const auto [root_a, sign_a] = graph.find(a);
  const auto [root_b, sign_b] = graph.find(b);
  return root_a == root_b ? sign_a * sign_b : 0;
}

TEST(EdgeWeight, HasTheSignOfAShare) {
  EdgeWeight weight(3);
  weight += EdgeWeight(-1);
  EXPECT_EQ(weight.sign(0.5), 1);
  EXPECT_EQ(weight.sign(0.51), 0);
  EXPECT_EQ(weight.turned(-1).sign(0.5), -1);
  EXPECT_EQ(EdgeWeight().sign(0.5), 0);
}

TEST(SignedGraph, JoinsWhatThreeQuartersSpeakFor) {
  for (const int sign : {1, -1}) {
    SignedGraph most = contracted(2, {{0, 1, EdgeWeight(3.1 * sign)}, {1, 0, EdgeWeight(-sign)}});
    EXPECT_EQ(sign_of(most, 0, 1), sign);
    SignedGraph some = contracted(2, {{0, 1, EdgeWeight(2.9 * sign)}, {1, 0, EdgeWeight(-sign)}});
    EXPECT_EQ(sign_of(some, 0, 1), 0);
  }
}

// Sides kept 0 and 1 apart until 2 came to 0, whose side is undecided since then.
TEST(SignedGraph, JoinsWhatASideKeptApartOnceItIsUndecided) {
  constexpr std::uint32_t kFree = 3;
  SignedGraph graph = contracted(3, {{0, kFree, EdgeWeight(2)},
                                     {1, kFree, EdgeWeight(4)},
                                     {0, 1, EdgeWeight(-40)},
                                     {2, kFree, EdgeWeight(2)},
                                     {2, kFree, EdgeWeight(-3)},
                                     {0, 2, EdgeWeight(6)}});
  EXPECT_EQ(sign_of(graph, 0, 2), 1);
  EXPECT_EQ(sign_of(graph, 0, 1), -1);
}

TEST(SignedGraph, TakesACannotLinkForOneSignAloneAndAsAPair) {
  for (const int sign : {1, -1}) {
    const SignedEdge over{0, 1, EdgeWeight::cannot_link(sign)};
    const SignedEdge pair{0, 1, EdgeWeight(sign)};
    const SignedEdge turned{0, 1, EdgeWeight(-0.01 * sign)};
    SignedGraph alone = contracted(2, {over, over});
    EXPECT_EQ(sign_of(alone, 0, 1), 0);
    SignedGraph as_many = contracted(2, {over, over, pair, pair});
    EXPECT_EQ(sign_of(as_many, 0, 1), 0);
    SignedGraph fewer = contracted(2, {over, over, pair, pair, pair});
    EXPECT_EQ(sign_of(fewer, 0, 1), sign);
    SignedGraph other = contracted(2, {over, over, turned});
    EXPECT_EQ(sign_of(other, 0, 1), -sign);
  }
}

TEST(SignedGraph, JoinsClustersThatAgreeAsAWhole) {
  // 1 and 2 are opposite. Node 0 agrees with both alike, 3 agrees with 1 and hardly with 2.
  SignedGraph graph = contracted(4, {{0, 1, EdgeWeight(20)},
                                     {0, 2, EdgeWeight(20)},
                                     {1, 2, EdgeWeight(-30)},
                                     {1, 3, EdgeWeight(8)},
                                     {2, 3, EdgeWeight(0.2)}});
  EXPECT_EQ(sign_of(graph, 1, 2), -1);
  EXPECT_EQ(sign_of(graph, 1, 3), 1);
  EXPECT_EQ(sign_of(graph, 0, 1), 0);
}

TEST(SignedGraph, LeavesApartWhatContradictsKnownSides) {
  constexpr std::uint32_t kFree = 3;
  for (const int sign : {1, -1}) {
    SignedGraph graph = contracted(kFree, {{0, kFree, EdgeWeight(5)},
                                           {1, kFree, EdgeWeight(5 * sign)},
                                           {0, 1, EdgeWeight(-40)},
                                           {1, 2, EdgeWeight(-1)}});
    EXPECT_EQ(sign_of(graph, 0, 1), sign < 0 ? -1 : 0);
    EXPECT_EQ(sign_of(graph, 1, 2), -1);
    EXPECT_EQ(graph.side(2).sum, sign < 0 ? 10 : -5);
    EXPECT_EQ(graph.side(2).size, sign < 0 ? 10 : 5);
    EXPECT_EQ(sign_of(graph, 0, kFree), 0);
  }
}

/// The same by the rule alone: all edges are summed again before each step.
class SummedAgain {
 public:
  SummedAgain(std::size_t nodes, std::vector<SignedEdge> edges)
      : sets_(nodes + 1), nodes_(static_cast<std::uint32_t>(nodes)), edges_(std::move(edges)) {
    while (join_best()) {
    }
  }

  [[nodiscard]] int sign(std::uint32_t a, std::uint32_t b) {
    const auto [root_a, sign_a] = sets_.find(a);
    const auto [root_b, sign_b] = sets_.find(b);
    return root_a == root_b ? sign_a * sign_b : 0;
  }

 private:
  [[nodiscard]] EdgeWeight between(std::uint32_t a, std::uint32_t b) {
    EdgeWeight sum;
    for (const SignedEdge& edge : edges_) {
      if (sign(edge.a, edge.b) != 0) continue;
      const int straight = sign(edge.a, a) * sign(edge.b, b);
      sum += straight != 0 ? edge.weight.turned(straight) : EdgeWeight();
      const int crossed = sign(edge.a, b) * sign(edge.b, a);
      sum += crossed != 0 ? edge.weight.turned(crossed) : EdgeWeight();
    }
    return sum;
  }

  bool join_best() {
    double best = 0;
    std::pair<std::uint32_t, std::uint32_t> pair;
    int best_sign = 0;
    for (std::uint32_t a = 0; a < nodes_; ++a) {
      for (std::uint32_t b = a + 1; b < nodes_; ++b) {
        if (sign(a, b) != 0) continue;
        const EdgeWeight weight = between(a, b);
        const double gain = std::abs(weight.sum) - kCoherent * weight.size;
        if (!(gain > best + 1e-9)) continue;
        best = gain;
        pair = {a, b};
        best_sign = weight.sum < 0 ? -1 : 1;
      }
    }
    if (best_sign != 0) sets_.join(pair.first, pair.second, best_sign);
    return best_sign != 0;
  }

  detail::SignedSets sets_;
  std::uint32_t nodes_;
  std::vector<SignedEdge> edges_;
};

TEST(SignedGraph, JoinsWhatSummingAgainJoins) {
  constexpr std::uint32_t kNodes = 10;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int joined = 0;
  int apart = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<SignedEdge> edges;
    for (std::size_t k = 10 + random() % 30; k > 0; --k) {
      const auto a = static_cast<std::uint32_t>(random() % kNodes);
      const auto b = static_cast<std::uint32_t>(random() % kNodes);
      const bool over = random() % 4 == 0;
      edges.push_back({a, b,
                       over ? EdgeWeight::cannot_link(random() % 2 == 0 ? 1 : -1)
                            : EdgeWeight(normal(random))});
    }
    SignedGraph graph = contracted(kNodes, edges);
    SummedAgain expected(kNodes, edges);
    for (std::uint32_t a = 0; a < kNodes; ++a) {
      for (std::uint32_t b = 0; b < a; ++b) {
        ASSERT_EQ(sign_of(graph, a, b), expected.sign(a, b)) << run;
        ++(sign_of(graph, a, b) == 0 ? apart : joined);
      }
    }
  }
  EXPECT_GT(joined, 1000);
  EXPECT_GT(apart, 1000);
}

constexpr double kLength = 60;

/// Two sides over 60 x 50 with a point per unit area each, z = half of `thickness` off the middle.
template <class Thickness>
std::vector<Vector3f> blade(const Thickness& thickness) {
  test::Clouds clouds(7);
  std::vector<Vector3f> points;
  for (int k = 0; k < 6000; ++k) {
    const double x = clouds.uniform(0, kLength);
    const double half = thickness(x) / 2;
    const double y = clouds.uniform(0, 50);
    points.push_back(Eigen::Vector3d(x, y, k % 2 == 0 ? half : -half).cast<float>());
  }
  return points;
}

/// Are nearly all normals outward where it is thicker than `least`?
void expect_outward(const std::vector<Vector3f>& blade, double least) {
  PointCloud cloud;
  cloud.positions = blade;
  const SurfacePoints points = prepare(cloud).points;
  int outward = 0;
  int all = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float z = points.grid.points()[i].z();
    if (2 * std::abs(z) < least) continue;
    ++all;
    if (z * points.normals[i].z() > 0) ++outward;
  }
  EXPECT_GT(all, 1000);
  EXPECT_GT(outward, 0.99 * all);
}

TEST(SignedGraph, LeavesTheSidesOfABladeApartWhoseEdgeIsThinnerThanItsPointsAreApart) {
  for (const double thickness : {2.5, 4.0, 6.0}) {
    SCOPED_TRACE(thickness);
    expect_outward(blade([&](double x) { return thickness * (1 - x / kLength); }), 1.5);
  }
}

TEST(SignedGraph, LeavesTheSidesOfALensApart) {
  for (const double thickness : {2.0, 2.5, 3.0}) {
    SCOPED_TRACE(thickness);
    const auto across = [](double x) { return 2 * x / kLength - 1; };
    expect_outward(blade([&](double x) { return thickness * (1 - across(x) * across(x)); }), 1);
  }
}

/// A box of 10 x 30 x `height` on a floor that goes on beneath it, a point per unit area.
std::vector<Vector3f> box_on_floor(unsigned seed, int height) {
  test::Clouds clouds(seed);
  std::vector<Vector3f> points;
  const auto off = [&] { return clouds.uniform(0.2, 0.8); };
  const auto add = [&](double x, double y, double z) {
    points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  };
  for (int i = -20; i < 30; ++i) {
    for (int j = -20; j < 50; ++j) add(i + off(), j + off(), 0);
  }
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 30; ++j) add(i + off(), j + off(), height);
    for (int k = 0; k < height; ++k) {
      for (const double y : {0., 30.}) add(i + off(), y, k + off());
    }
  }
  for (int j = 0; j < 30; ++j) {
    for (int k = 0; k < height; ++k) {
      for (const double x : {0., 10.}) add(x, j + off(), k + off());
    }
  }
  return points;
}

TEST(SignedGraph, LeavesMostBoxesApartFromAFloorThatGoesOnBeneathThem) {
  int apart = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    PointCloud cloud;
    cloud.positions = box_on_floor(seed, 8);
    const SurfacePoints points = prepare(cloud).points;
    const auto component_at = [&](const Vector3f& place) {
      std::vector<CellGrid::Neighbor> nearest;
      points.grid.nearest(place - points.origin.cast<float>(), 1, nearest);
      const std::uint32_t segment = points.segments.segment[nearest.front().index];
      EXPECT_NE(segment, SurfacePoints::Segments::kNone);
      return segment == SurfacePoints::Segments::kNone ? segment
                                                       : points.segments.component[segment];
    };
    const std::uint32_t floor = component_at({-10, 15, 0});
    EXPECT_EQ(component_at({5, 15, 0}), floor) << seed;
    const bool together = component_at({5, 15, 8}) == floor || component_at({0, 15, 4}) == floor ||
                          component_at({5, 30, 4}) == floor;
    apart += together ? 0 : 1;
  }
  EXPECT_GE(apart,
            34);  // of 300 seeds 268 are, and 242 where edges are taken in an order that stays
}

}  // namespace
}  // namespace palpate
