#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "field/patch.hpp"
#include "palpate/scene/handoff.hpp"
#include "palpate/scene/snapshot.hpp"

namespace palpate {

/// One source's snapshots as one reader sees them: the current one and, while its start lies ahead,
/// the next. Everything but construction and destruction is real-time.
class SourceView {
 public:
  /// `name`: of the reader. @throws Error when the source has no reader's place left.
  SourceView(Handoff<Snapshot>& handoff, const std::string& name);
  ~SourceView();
  SourceView(const SourceView&) = delete;
  SourceView& operator=(const SourceView&) = delete;

  /// Looks for a new snapshot and brings everything to time `now`, s, which is finite. True when
  /// that moved or changed the surface. A snapshot that waits for its start is replaced by a newer
  /// one only when it starts unreasonably late.
  bool advance(double now) noexcept;

  /// nullptr: no surface now; one that has faded away is none.
  [[nodiscard]] const Snapshot* current() const noexcept { return there_ ? current_ : nullptr; }

  /// How sure the current snapshot is now, 0-1; 0 without one.
  [[nodiscard]] double presence() const noexcept { return presence_; }

  /// The reader's place at the source.
  [[nodiscard]] std::size_t reader() const noexcept { return reader_; }

  /// The current snapshot's k-th layer as it counts now.
  [[nodiscard]] ActiveLayer layer(std::size_t k, int source) const noexcept;

 private:
  void look(double now) noexcept;
  void forget() noexcept;
  void change_over(double now) noexcept;
  [[nodiscard]] double progress_at(double now) const noexcept;

  Handoff<Snapshot>* handoff_;
  std::size_t reader_;
  std::size_t slot_ = 0;  // that holds `current_`; the other holds `next_`
  const Snapshot* current_ = nullptr;
  const Snapshot* next_ = nullptr;
  double begin_ = 0;  // when the current one began to be shown, s
  double span_ = 0;   // and in which it comes to its end, s
  double shown_ = -std::numeric_limits<double>::infinity();  // time of the last advance()
  double sure_ = -std::numeric_limits<double>::infinity();   // when presence was last above 0, s
  double progress_ = 0;
  double presence_ = 0;
  bool there_ = false;
};

}  // namespace palpate
