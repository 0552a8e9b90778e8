// Weighs the newest clouds of a source against each other (docs/method.md 7.2).
#include "stream/layer_history.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace palpate {
namespace {

constexpr double kNoWeight = 1e-9;  // of 1; judgement: far below what a force resolves

}  // namespace

void LayerHistory::add(std::shared_ptr<const SurfacePoints> newest, const FrameTiming& moment,
                       std::vector<Snapshot::Layer>& layers) {
  age(moment);
  layers_.push_back({std::move(newest), 0, 0});
  const auto most =
      policy_ == Policy::crossfade ? Snapshot::kMaxLayers : static_cast<std::size_t>(history_);
  if (layers_.size() > most) drop();
  weigh();
  last_ = moment;
  layers.assign(layers_.begin(), layers_.end());
}

/// Brings the weights to the new start and drops the clouds that have faded away.
void LayerHistory::age(const FrameTiming& moment) {
  const double u = progress(last_, moment.start);
  for (Snapshot::Layer& layer : layers_) {
    layer.weight_start += u * (layer.weight_end - layer.weight_start);
  }
  std::erase_if(layers_, [](const Snapshot::Layer& layer) {
    return layer.weight_start <= kNoWeight && layer.weight_end <= kNoWeight;
  });
}

/// Makes room: drops the cloud that weighs least. A crossfade of four comes to this when clouds
/// arrive at three times their rate.
void LayerHistory::drop() {
  const auto least = policy_ == Policy::crossfade
                         ? std::min_element(layers_.begin(), layers_.end() - 1,
                                            [](const Snapshot::Layer& a, const Snapshot::Layer& b) {
                                              return a.weight_start < b.weight_start;
                                            })
                         : layers_.begin();
  layers_.erase(least);
}

void LayerHistory::weigh() {
  const std::size_t counted = std::min(layers_.size(), static_cast<std::size_t>(history_));
  const double share = 1 / static_cast<double>(counted);
  for (std::size_t k = 0; k < layers_.size(); ++k) {
    const bool counts = layers_.size() - k <= counted;
    layers_[k].weight_end = counts ? share : 0;
    if (policy_ != Policy::crossfade) layers_[k].weight_start = layers_[k].weight_end;
  }
  const double sum = std::accumulate(
      layers_.begin(), layers_.end(), 0.0,
      [](double total, const Snapshot::Layer& layer) { return total + layer.weight_start; });
  if (sum <= 0) layers_.back().weight_start = 1;
  // The sum is not 1 if a cloud was dropped early, or by rounding.
  for (Snapshot::Layer& layer : layers_) layer.weight_start /= sum > 0 ? sum : 1;
}

}  // namespace palpate
