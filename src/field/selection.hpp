#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "field/active_layer.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

struct SelectOptions {
  double radius = 0;         ///< R of all points, m; 0: each has its own
  bool raw_weights = false;  ///< density weights do not count
  int most_visits = 1 << 30;
};

/// Chooses the points of a patch: all whose support reaches into a ball at any time until the
/// layers' `until`. When they are more than there is room for, every 2nd, 4th, ... of the index's
/// order. All memory is taken by the constructor.
class Selection {
 public:
  /// What was chosen of one layer.
  struct Run {
    double from = 0;  ///< progress
    double until = 0;
    bool counts = false;      // does its weight let it be seen at any time until then?
    std::uint32_t first = 0;  ///< of the places
    std::uint32_t count = 0;
  };

  /// `capacity`: the places, when each source's are filled up to a multiple of simd::kLanes.
  explicit Selection(std::size_t capacity);

  /// `layers`: in the order of their sources. False when it has made `most_visits` and did not come
  /// to the end, or there are more than kMostLayers; then nothing is chosen.
  [[nodiscard]] bool choose(std::span<const ActiveLayer> layers, const Ball& ball,
                            const SelectOptions& options) noexcept;

  /// Chooses once more in the same ball. `before`: for each layer, which of the runs so far is also
  /// what would be chosen of it now, and is taken over; kNone: there is none.
  [[nodiscard]] bool renew(std::span<const ActiveLayer> layers, std::span<const std::size_t> before,
                           int most_visits) noexcept;

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// One for each layer.
  [[nodiscard]] std::span<const Run> runs() const noexcept { return runs_; }
  /// Indices in the layer's sorted order, rising.
  [[nodiscard]] std::span<const std::uint32_t> places(const Run& run) const noexcept {
    return std::span(places_).subspan(run.first, run.count);
  }
  [[nodiscard]] std::uint32_t stride() const noexcept { return stride_; }
  /// Cells and points that were looked at.
  [[nodiscard]] int visits() const noexcept { return visits_; }

 private:
  void begin() noexcept;
  [[nodiscard]] bool choose_all(std::span<const ActiveLayer> layers,
                                std::span<const std::size_t> before) noexcept;
  [[nodiscard]] bool take_over(const Run& run) noexcept;
  [[nodiscard]] bool take(std::uint32_t place) noexcept;
  [[nodiscard]] bool walk(const ActiveLayer& layer) noexcept;
  [[nodiscard]] bool take_near(const ActiveLayer& start, const ActiveLayer& last,
                               std::uint32_t begin, std::uint32_t end) noexcept;
  [[nodiscard]] bool reaches(const ActiveLayer& start, const ActiveLayer& last,
                             std::uint32_t i) const noexcept;
  [[nodiscard]] bool counts(const ActiveLayer& start, const ActiveLayer& last,
                            std::uint32_t i) const noexcept;
  void thin() noexcept;
  [[nodiscard]] std::size_t filled_up(std::span<const ActiveLayer> layers) const noexcept;

  std::vector<std::uint32_t> places_, places_before_;
  std::vector<Run> runs_, runs_before_;
  std::uint32_t used_ = 0;
  std::uint32_t stride_ = 1;
  int visits_ = 0;
  Ball ball_;
  SelectOptions options_;
};

}  // namespace palpate
