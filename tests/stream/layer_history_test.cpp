// Checks the weights of replace, average and crossfade.
#include "stream/layer_history.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "support/rates.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using test::kFrame;

// Clouds are told apart by their addresses; the field does not look into them here.
std::shared_ptr<const SurfacePoints> cloud() {
  return std::make_shared<const SurfacePoints>();
}

double sum_at(const std::vector<Snapshot::Layer>& layers, double u) {
  double sum = 0;
  for (const Snapshot::Layer& layer : layers) {
    sum += layer.weight_start + u * (layer.weight_end - layer.weight_start);
  }
  return sum;
}

TEST(LayerHistory, ReplaceKeepsTheNewestAlone) {
  LayerHistory history(Policy::replace, 1);
  std::vector<Snapshot::Layer> layers;
  for (int k = 0; k < 5; ++k) {
    const auto newest = cloud();
    history.add(newest, {k * kFrame, k * kFrame, kFrame}, layers);
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers[0].points, newest);
    EXPECT_EQ(layers[0].weight_start, 1);
    EXPECT_EQ(layers[0].weight_end, 1);
  }
}

TEST(LayerHistory, AverageWeighsTheNewestAlike) {
  LayerHistory history(Policy::average, 4);
  std::vector<Snapshot::Layer> layers;
  std::vector<std::shared_ptr<const SurfacePoints>> clouds;
  for (std::size_t k = 0; k < 9; ++k) {
    clouds.push_back(cloud());
    history.add(clouds.back(), {k * kFrame, k * kFrame, kFrame}, layers);
    const std::size_t count = std::min<std::size_t>(k + 1, 4);
    ASSERT_EQ(layers.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(layers[i].points, clouds[k + 1 - count + i]) << "used again, not made anew";
      EXPECT_DOUBLE_EQ(layers[i].weight_start, 1.0 / static_cast<double>(count));
      EXPECT_EQ(layers[i].weight_start, layers[i].weight_end);
    }
  }
}

TEST(LayerHistory, CrossfadeMovesTheWeightsOfTheNewestAndTheOldest) {
  LayerHistory history(Policy::crossfade, 4);
  std::vector<Snapshot::Layer> layers;
  for (int k = 0; k < 9; ++k) history.add(cloud(), {k * kFrame, k * kFrame, kFrame}, layers);
  ASSERT_EQ(layers.size(), 5u);
  EXPECT_NEAR(layers.front().weight_start, 0.25, 1e-12);
  EXPECT_NEAR(layers.front().weight_end, 0, 1e-12);
  EXPECT_NEAR(layers.back().weight_start, 0, 1e-12);
  EXPECT_NEAR(layers.back().weight_end, 0.25, 1e-12);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(layers[i].weight_start, 0.25, 1e-12);
    EXPECT_NEAR(layers[i].weight_end, 0.25, 1e-12);
  }
}

// Whenever clouds come, every cloud's weight goes on from where it is, and all sum to 1.
TEST(LayerHistory, CrossfadeNeverSteps) {
  std::mt19937 random(5);
  for (const int n : {1, 2, 4, 6}) {
    std::uniform_real_distribution<double> gap(0.5 * kFrame, 1.9 * kFrame);
    LayerHistory history(Policy::crossfade, n);
    std::vector<Snapshot::Layer> layers;
    std::map<const SurfacePoints*, double> before;
    double start = 0;
    double last_start = 0;
    for (int k = 0; k < 200; ++k) {
      start += gap(random);
      const double u = std::min((start - last_start) / kFrame, 1.0);
      before.clear();
      for (const Snapshot::Layer& layer : layers) {
        before[layer.points.get()] =
            layer.weight_start + u * (layer.weight_end - layer.weight_start);
      }
      const auto held = layers;  // addresses stay theirs
      history.add(cloud(), {start, start, kFrame}, layers);
      ASSERT_LE(layers.size(), Snapshot::kMaxLayers);
      for (const Snapshot::Layer& layer : layers) {
        const auto found = before.find(layer.points.get());
        const double expected = k == 0 ? 1 : found == before.end() ? 0 : found->second;
        EXPECT_NEAR(layer.weight_start, expected, n < 6 ? 5e-3 : 0.03);
      }
      for (const double at : {0.0, 0.3, 1.0}) EXPECT_NEAR(sum_at(layers, at), 1, 1e-12);
      last_start = start;
    }
  }
}

TEST(LayerHistory, ForgetsWhatWas) {
  LayerHistory history(Policy::average, 4);
  std::vector<Snapshot::Layer> layers;
  for (int k = 0; k < 3; ++k) history.add(cloud(), {k * kFrame, k * kFrame, kFrame}, layers);
  history.forget();
  history.add(cloud(), {1, 1, kFrame}, layers);
  EXPECT_EQ(layers.size(), 1u);
}

}  // namespace
}  // namespace palpate
