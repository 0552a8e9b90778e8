#pragma once

#include <cstddef>

#include "field/patch.hpp"
#include "palpate/scene/handoff.hpp"
#include "palpate/scene/snapshot.hpp"

namespace palpate {

/// One source's snapshots as one reader sees them: the current one and, while its start lies ahead,
/// the next. Everything but construction and destruction is real-time.
class SourceView {
 public:
  /// @throws Error when the source has no reader's place left.
  explicit SourceView(Handoff<Snapshot>& handoff);
  ~SourceView();
  SourceView(const SourceView&) = delete;
  SourceView& operator=(const SourceView&) = delete;

  /// Looks for a new snapshot and brings everything to time `now`, s, which is finite. True when
  /// that moved or changed the surface. A snapshot that waits for its start is replaced by a newer
  /// one only when it starts unreasonably late.
  bool advance(double now) noexcept;

  /// nullptr: no surface now.
  [[nodiscard]] const Snapshot* current() const noexcept { return current_; }

  /// How sure the current snapshot is now, 0-1; 0 without one.
  [[nodiscard]] double presence() const noexcept;

  /// The current snapshot's k-th layer as it counts now.
  [[nodiscard]] ActiveLayer layer(std::size_t k, int source) const noexcept;

 private:
  void look(double now) noexcept;
  void forget() noexcept;
  void change_over(double now) noexcept;

  Handoff<Snapshot>* handoff_;
  std::size_t reader_;
  std::size_t slot_ = 0;  // that holds `current_`; the other holds `next_`
  const Snapshot* current_ = nullptr;
  const Snapshot* next_ = nullptr;
  double progress_ = 0;
};

}  // namespace palpate
