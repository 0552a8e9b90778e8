#pragma once

#include <memory>
#include <vector>

#include "depth/frame_timing.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// The policies that weigh whole clouds: replace, average and crossfade (docs/method.md 7.2).
/// Clouds are indexed once and shared by the snapshots that they count in.
class LayerHistory {
 public:
  /// `policy`: one of the three. `history`: N.
  LayerHistory(Policy policy, int history) : policy_(policy), history_(history) {}

  /// Fills `layers` with the newest cloud and those before it. Weights sum to 1 at every time, and
  /// under crossfade they go on from what they are at the moment's start.
  void add(std::shared_ptr<const SurfacePoints> newest, const FrameTiming& moment,
           std::vector<Snapshot::Layer>& layers);

  void forget() { layers_.clear(); }

 private:
  void age(const FrameTiming& moment);
  void drop();
  void weigh();

  Policy policy_;
  int history_;
  FrameTiming last_;
  std::vector<Snapshot::Layer> layers_;  // oldest first
};

}  // namespace palpate
