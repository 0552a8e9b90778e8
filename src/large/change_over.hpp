// Fades from one surface of a cloud to another one of the same cloud.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/source.hpp"

namespace palpate {

/// A surface that does not change, as a snapshot.
[[nodiscard]] inline Snapshot still(SurfacePoints points) {
  Snapshot snapshot;
  snapshot.layers.push_back({std::make_shared<const SurfacePoints>(std::move(points)), 1, 1});
  return snapshot;
}

/// Replaces the blocks of a cloud by all of it prepared together, which differs from them a little:
/// two layers while it fades in, then one.
class ChangeOver {
 public:
  ChangeOver(Prepared blocks, Prepared together)
      : report_(together.report),
        fading_(still(std::move(blocks.points))),
        still_(still(std::move(together.points))) {
    fading_->layers.front().weight_end = 0;
    fading_->layers.push_back({still_.layers.front().points, 0, 1});
  }

  /// What to publish at `now`, for a fade of `seconds` that begins after `lead`, s; nothing while
  /// the fade lasts.
  [[nodiscard]] std::optional<Snapshot> next(double now, double lead, double seconds) {
    if (!fading_) return now < end_ ? std::optional<Snapshot>() : still_;
    Snapshot snapshot = *std::exchange(fading_, std::nullopt);
    snapshot.start = now + lead;
    snapshot.end = end_ = snapshot.start + seconds;
    return snapshot;
  }

  [[nodiscard]] const Prepared::Report& report() const { return report_; }  ///< of the new one

 private:
  Prepared::Report report_;
  std::optional<Snapshot> fading_;  // until it was published
  Snapshot still_;
  double end_ = 0;  // of the fade, s
};

}  // namespace palpate
