// docs/method.md 10: sweeps against brute-force sampling, 0 missed contacts.
#include <gtest/gtest.h>

#include "contact/probe.hpp"
#include "support/effort.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Vector3d kFarAway(0, 0, 1);

struct SweepScene {
  const char* name;
  std::vector<TestPoint> (*make)(const Sampling& sampling);
  double extent;       // of the points in x and y, m
  double height;       // within which the middles of ways lie, m
  int least_contacts;  // that are compared; ways from close behind a known side begin inside of it
};

std::vector<TestPoint> noisy_sheet(Sampling sampling) {
  sampling.jitter = 0.2;
  sampling.noise = 0.25;
  sampling.tilt = 0.1;
  return sheet(sampling, 0.05);
}

std::vector<TestPoint> single(const Sampling& sampling) {
  return {{Vector3d::Zero(), Vector3d::UnitZ(), sampling.radius, 0}};
}

std::vector<TestPoint> two_sheets(const Sampling& sampling) {
  std::vector<TestPoint> points = sheet(sampling, 0.05, 0.01);
  const auto more = sheet(sampling, 0.05, -0.01);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

const SweepScene kScenes[] = {
    {"sheet", [](const Sampling& s) { return sheet(s, 0.05); }, 0.05, 0.008, 2200},
    {"noisy_sheet", [](const Sampling& s) { return noisy_sheet(s); }, 0.05, 0.008, 2000},
    {"line", [](const Sampling& s) { return line(s, 0.05); }, 0.05, 0.007, 1000},
    {"single_point", single, 0.008, 0.007, 1200},
    {"two_sheets", two_sheets, 0.05, 0.014, 2200},
};

/// Where brute force first finds something solid along the way, and how long the chord is.
struct Truth {
  double first = -1;  // m from the start; -1: free all the way
  double chord = 0;   // m
};

Truth brute_force(const Field& field, const Vector3d& from, const Vector3d& to, double step) {
  const double length = (to - from).norm();
  const int count = static_cast<int>(std::ceil(length / step));
  Truth truth;
  for (int i = 0; i <= count; ++i) {
    const Vector3d x = from + (to - from) * (static_cast<double>(i) / count);
    const Sample here = field.sample(x);
    if (here.value <= 0) {
      if (truth.first < 0) truth.first = i * length / count;
      truth.chord = i * length / count - truth.first + step;
      if (truth.chord > 0.2 * here.radius) return truth;
    } else if (truth.first >= 0) {
      return truth;
    }
  }
  return truth;
}

struct Tally {
  int contacts = 0;
  int missed = 0;   // chords longer than the field's resolution
  int grazing = 0;  // shorter ones that were not found
  int late = 0;
  int phantom = 0;
  int truncated = 0;
};

void compare(PointField& scene, const Vector3d& from, const Vector3d& to, double radius,
             Tally& tally) {
  (void)scene.at(kFarAway, kFarAway);  // nothing that was seen before counts
  const Field& field = scene.at(to, from);
  if (!(field.sample(from).value > 0)) return;
  const double step = 0.002 * radius;
  const Truth truth = brute_force(field, from, to, step);
  const Texture none;
  Probe probe(field, none, radius);
  const Sweep found = first_contact(probe, from, to);
  const double reached = (found.position - from).norm();
  tally.contacts += truth.first >= 0 ? 1 : 0;
  // A longer way than a hand goes in a millisecond may take several steps.
  if (found.end == Sweep::End::truncated && (to - from).norm() < 0.05) ++tally.truncated;
  if (truth.first < 0) {
    // Brute force may step over a corner cut that the sweep finds.
    tally.phantom += found.end == Sweep::End::hit ? 1 : 0;
  } else if (found.end == Sweep::End::clear) {
    ++(truth.chord > field.traits().resolution ? tally.missed : tally.grazing);
  } else if (reached > truth.first + step && truth.chord > field.traits().resolution) {
    ++tally.late;
  }
}

using SweepCase = std::tuple<int, FieldOptions::Kind>;
class AcceptanceSweep : public testing::TestWithParam<SweepCase> {};

TEST_P(AcceptanceSweep, MissesNothingThatBruteForceFinds) {
  const auto& [index, kind] = GetParam();
  Tally tally;
  std::mt19937 random(17 + static_cast<unsigned>(index));
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double m : {1.5, 2.0, 3.0}) {
    const double radius = 4e-3 * m;
    PointField scene(kScenes[index].make({.radius = radius}), {.kind = kind});
    for (const auto& [length, repeats] :
         {std::pair{1e-3, 6000}, {2e-3, 4500}, {20e-3, 750}, {100e-3, 150}}) {
      for (int i = 0; i < effort(repeats); ++i) {
        // Through a place near the points, in any direction.
        const double wide = 1.1 * kScenes[index].extent;
        const double high = kScenes[index].height;
        const Vector3d center(wide * uniform(random), std::min(wide, 2.5 * high) * uniform(random),
                              high * uniform(random));
        const Vector3d way =
            length * Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
        const double share = length < 0.01 ? 0.5 : 0.5 * (1 + uniform(random));
        compare(scene, center - share * way, center + (1 - share) * way, radius, tally);
      }
    }
  }
  RecordProperty("contacts", tally.contacts);
  RecordProperty("grazing", tally.grazing);
  RecordProperty("phantom", tally.phantom);
  RecordProperty("truncated", tally.truncated);
  EXPECT_EQ(tally.missed, 0) << "of " << tally.contacts << " contacts";
  EXPECT_EQ(tally.late, 0) << "of " << tally.contacts << " contacts";
  EXPECT_GT(tally.contacts, effort(kScenes[index].least_contacts));
  EXPECT_LE(tally.phantom, 1 + tally.contacts / 150);
  EXPECT_LE(tally.truncated, 1 + tally.contacts / 1000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, AcceptanceSweep,
                         testing::Combine(testing::Range(0, 5),
                                          testing::Values(FieldOptions::Kind::metaball,
                                                          FieldOptions::Kind::balanced)),
                         [](const auto& tested) {
                           return std::string(kScenes[std::get<0>(tested.param)].name) +
                                  (std::get<1>(tested.param) == FieldOptions::Kind::metaball
                                       ? "_metaball"
                                       : "_balanced");
                         });

}  // namespace
}  // namespace palpate::test
