#include "scene/source_view.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// A snapshot that starts later than this is a mistake of clocks, s.
constexpr double kPatience = 1;

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
  progress_ = current_ ? palpate::progress(*current_, now) : 0;
  const bool there_before = presence_ > 0;
  presence_ = current_ ? palpate::presence(*current_, now) : 0;
  return current_ != snapshot_before || progress_ != progress_before ||
         there_before != (presence_ > 0);
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
}

ActiveLayer SourceView::layer(std::size_t k, int source) const noexcept {
  const Layer& layer = current_->layers[k];
  const double duration = current_->end - current_->start;
  const bool under_way = progress_ > 0 && progress_ < 1;
  return {layer.points.get(), source,
          layer.weight_start + progress_ * (layer.weight_end - layer.weight_start), progress_,
          duration > 0 && under_way ? 1 / duration : 0};
}

}  // namespace palpate
