#include "viewer/troubles.hpp"

#include <fmt/core.h>

#include <utility>

namespace palpate::viewer {
namespace {

bool lasts(const StreamState& stream) {
  return stream.phase == StreamPhase::stalled || stream.phase == StreamPhase::failed;
}

}  // namespace

std::vector<Notice> Troubles::look(std::span<const ViewerStream> streams,
                                   std::span<const DeviceFault> devices) {
  std::vector<Notice> news;
  present_.clear();
  for (const ViewerStream& stream : streams) {
    const Notice notice{NoticeLevel::warning, stream.state.problem};
    if (is_new(stream.state)) news.push_back(notice);
    if (lasts(stream.state) && !notice.text.empty()) present_.push_back(notice);
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const auto& [name, fault] = devices[i];
    const bool changed = std::exchange(faults_[i], fault) != fault;
    if (fault == GuardFault::none) continue;
    present_.push_back({NoticeLevel::fault, fmt::format("{}: {}", name, in_words(fault))});
    if (changed) news.push_back(present_.back());
  }
  return news;
}

// A problem that repeats itself with every frame is told once.
bool Troubles::is_new(const StreamState& stream) {
  Problem& last = problems_[stream.source];
  const bool repeated = last.words == stream.problem && stream.problem_at - last.time <= kPeace;
  last = {stream.problem, stream.problem_at};
  return !stream.problem.empty() && !repeated;
}

}  // namespace palpate::viewer
