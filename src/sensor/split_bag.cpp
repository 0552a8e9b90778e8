// Reads recordings that were split into several MCAP files.
#include "sensor/split_bag.hpp"

#include <fmt/format.h>

namespace palpate::sensor {

SplitBag::SplitBag(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    parts_.push_back({file, std::make_unique<bag::McapReader>(file)});
    for (const auto& [number, channel] : parts_.back().reader->contents().channels) {
      channels_.push_back(channel);
    }
  }
}

void SplitBag::choose(const std::function<bool(const bag::Channel&)>& wanted) {
  at_ = 0;
  for (const Part& part : parts_) part.reader->choose(wanted);
}

bool SplitBag::next(bag::Message& message) {
  while (!parts_[at_].reader->next(message)) {
    if (at_ + 1 == parts_.size()) return false;
    ++at_;
  }
  return true;
}

std::optional<std::string> SplitBag::next_loss() {
  for (Part& part : parts_) {
    const auto& losses = part.reader->contents().losses;
    if (part.reported < losses.size())
      return fmt::format("{}: {}", part.file, losses[part.reported++]);
  }
  return {};
}

}  // namespace palpate::sensor
