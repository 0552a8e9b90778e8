// Surfaces with wrong columns and wrong times: they are refused with a reason, or they are felt,
// and no force is none, infinite or beyond what a spring gives.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "palpate/base/error.hpp"
#include "palpate/contact/proxy.hpp"
#include "support/all_columns.hpp"
#include "support/effort.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Draws wrong values.
class Wrong {
 public:
  explicit Wrong(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t count) { return random_() % count; }
  float number() {
    constexpr std::array<float, 12> kNumbers = {std::numeric_limits<float>::quiet_NaN(),
                                                std::numeric_limits<float>::infinity(),
                                                -std::numeric_limits<float>::infinity(),
                                                std::numeric_limits<float>::max(),
                                                std::numeric_limits<float>::denorm_min(),
                                                1e19f,
                                                -1,
                                                0,
                                                1,
                                                1e-3f,
                                                10,
                                                1e30f};
    return kNumbers[below(kNumbers.size())];
  }
  double time() {
    constexpr std::array<double, 10> kTimes = {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, 1.7e9,
                                               -1,           0,        1e-300,    33,    0.5};
    return kTimes[below(kTimes.size())];
  }
  void spoil(float& value) { value = number(); }
  void spoil(std::uint8_t& value) { value = static_cast<std::uint8_t>(random_()); }
  void spoil(std::uint32_t& value) {
    constexpr std::array<std::uint32_t, 5> kIndices = {0, 1, 81, 1u << 30, ~std::uint32_t{1}};
    value = kIndices[below(kIndices.size())];
  }
  void spoil(Vector3f& value) { value[static_cast<Eigen::Index>(below(3))] = number(); }
  void spoil(std::array<std::uint8_t, 3>& value) { value[0] ^= 1; }
  void spoil(SurfacePoints::EdgePlane& edge) {
    const std::size_t which = below(3);
    if (which == 0) spoil(edge.normal);
    if (which == 1) spoil(edge.height);
    if (which == 2) spoil(edge.share);
  }
  /// An entry, all of them, or their number.
  template <class T>
  void spoil(std::vector<T>& column) {
    const std::size_t way = below(4);
    if (way == 0) return column.resize(below(2 * column.size() + 2));
    if (way == 1) {
      for (T& value : column) spoil(value);
    } else if (!column.empty()) {
      spoil(column[below(column.size())]);
    }
  }

 private:
  std::mt19937 random_;
};

void spoil_one(SurfacePoints& p, Wrong& wrong) {
  const auto pick = [&](auto&... columns) {
    std::size_t which = wrong.below(sizeof...(columns));
    ((which-- == 0 ? wrong.spoil(columns) : void()), ...);
  };
  pick(p.normals, p.density_weights, p.radii, p.confidences, p.segments.segment,
       p.segments.component, p.segments.known, p.segments.residual, p.materials, p.presences,
       p.colors, p.end_positions, p.end_normals, p.end_density_weights, p.end_radii,
       p.end_confidences, p.end_presences, p.edges.of_point, p.edges.start, p.edges.end,
       p.eye->remembered, p.cell_reach);
}

/// Presses into whatever is there.
void touches(Scene& scene, double start, unsigned seed) {
  SceneField field(scene);
  Proxy proxy;
  proxy.reset({0, 0, 0.02});
  for (int k = 0; k < 40; ++k) {
    const Vector3d hand(1e-4 * (seed % 7), 0, 0.02 - 6e-4 * k);
    field.update(start + 1e-3 * k, hand, proxy);
    const Contact contact = proxy.step(field, hand, 1e-3);
    ASSERT_TRUE(contact.force.allFinite() && contact.proxy.allFinite()) << seed;
    ASSERT_LE(contact.force.norm(), 1.001 * 500 * (contact.proxy - hand).norm() + 1e-6) << seed;
  }
}

/// False: it is refused.
bool is_published(Source& source, std::unique_ptr<Snapshot> snapshot) {
  try {
    source.publish(std::move(snapshot));
  } catch (const Error& error) {
    EXPECT_GT(std::string(error.what()).size(), 20u);
    return false;
  }
  return true;
}

TEST(WrongSurfaces, AreRefusedOrFelt) {
  const SurfacePoints good = all_columns();
  int felt = 0;
  const int runs = effort(5000);
  for (int run = 0; run < runs && !testing::Test::HasFatalFailure(); ++run) {
    Wrong wrong(static_cast<unsigned>(run));
    SurfacePoints points = good;
    const std::size_t faults = 1 + wrong.below(3);
    for (std::size_t k = 0; k < faults; ++k) spoil_one(points, wrong);
    if (wrong.below(2) == 0 && points.radii.size() == points.size() &&
        points.end_radii.size() <= points.size() && points.end_positions.size() <= points.size())
      finish(points);
    Scene scene;
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->end = 0.02;
    snapshot->layers.push_back({share(std::move(points)), 1, 1});
    if (!is_published(scene.add("wrong"), std::move(snapshot))) continue;
    touches(scene, 0, static_cast<unsigned>(run));
    ++felt;
  }
  EXPECT_GT(felt, runs / 50) << "some faults are none";
  EXPECT_LT(felt, runs / 2);
}

TEST(WrongTimes, AreRefusedOrFelt) {
  const auto points = share(all_columns());
  for (int run = 0; run < effort(3000) && !testing::Test::HasFatalFailure(); ++run) {
    Wrong wrong(static_cast<unsigned>(run));
    Scene scene;
    Source& source = scene.add("wrong");
    for (int k = 0; k < 3; ++k) {
      auto snapshot = std::make_unique<Snapshot>();
      for (double Snapshot::*time :
           {&Snapshot::start, &Snapshot::end, &Snapshot::silent_from, &Snapshot::fade,
            &Snapshot::interval, &Snapshot::spare, &Snapshot::stamp, &Snapshot::presence_end}) {
        if (wrong.below(4) == 0) (*snapshot).*time = wrong.time();
      }
      snapshot->layers.push_back({points, 1, 1});
      (void)is_published(source, std::move(snapshot));
    }
    touches(scene, wrong.below(2) == 0 ? 0 : wrong.time(), static_cast<unsigned>(run));
  }
}

}  // namespace
}  // namespace palpate::test
