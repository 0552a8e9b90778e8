#include "scene/source_view.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// A snapshot that starts later than this is a mistake of clocks, s.
constexpr double kPatience = 1;

// A surface that has faded away stays so long without any stiffness: proxies let their springs
// follow it with a delay (EnergyTank::kTime, a fifth of this). s
constexpr double kLinger = 0.1;

// However late it is, a snapshot takes this share of its duration.
constexpr double kLeastShare = 0.5;

}  // namespace

SourceView::SourceView(Handoff<Snapshot>& handoff, const std::string& name)
    : handoff_(&handoff), reader_(handoff.join(name)) {
  if (reader_ == Handoff<Snapshot>::kReaders) {
    throw Error(fmt::format("the scene has {} fields already; destroy one before making another",
                            Handoff<Snapshot>::kReaders));
  }
}

SourceView::~SourceView() {
  handoff_->leave(reader_);
}

bool SourceView::advance(double now) noexcept {
  const Snapshot* const snapshot_before = current_;
  const double progress_before = progress_;
  look(now);
  change_over(now);
  shown_ = now;
  progress_ = current_ ? progress_at(now) : 0;
  presence_ = current_ ? palpate::presence(*current_, now) : 0;
  if (presence_ > 0) sure_ = now;
  const bool there_before = std::exchange(there_, current_ && now - sure_ <= kLinger);
  return current_ != snapshot_before || progress_ != progress_before || there_ != there_before;
}

double SourceView::progress_at(double now) const noexcept {
  if (!(span_ > 0)) return now < begin_ ? 0 : 1;
  return std::clamp((now - begin_) / span_, 0.0, 1.0);
}

void SourceView::look(double now) noexcept {
  const Snapshot* newest = handoff_->peek();
  if (newest == current_ && !next_) return;
  if (newest && (newest == current_ || newest == next_)) return;
  if (!newest) return forget();
  if (next_ && next_->start - now <= kPatience) return;
  next_ = handoff_->acquire(reader_, 1 - slot_);
}

void SourceView::forget() noexcept {
  handoff_->release(reader_, slot_);
  handoff_->release(reader_, 1 - slot_);
  current_ = nullptr;
  next_ = nullptr;
}

void SourceView::change_over(double now) noexcept {
  if (!next_ || (current_ && now < next_->start)) return;
  handoff_->release(reader_, slot_);
  slot_ = 1 - slot_;
  current_ = next_;
  next_ = nullptr;
  // One that was published after its start begins where the last surface was shown last, and makes
  // up for the delay: it never begins on its way.
  const double duration = current_->end - current_->start;
  begin_ = std::max(current_->start, shown_);
  span_ = std::max(current_->end - begin_, kLeastShare * duration);
}

ActiveLayer SourceView::layer(std::size_t k, int source) const noexcept {
  const Layer& layer = current_->layers[k];
  const bool under_way = progress_ > 0 && progress_ < 1;
  return {layer.points.get(), source,
          layer.weight_start + progress_ * (layer.weight_end - layer.weight_start), progress_,
          under_way ? 1 / span_ : 0};
}

}  // namespace palpate
