#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bag/mcap_reader.hpp"

namespace palpate::sensor {

/// Reads the MCAP files of one recording one after another, as if they were one file.
class SplitBag {
 public:
  /// @throws Error as McapReader does.
  explicit SplitBag(const std::vector<std::string>& files);

  /// The channels of all files; parts of a recording mostly have the same ones.
  [[nodiscard]] const std::vector<bag::Channel>& channels() const { return channels_; }

  /// Does what McapReader::choose() does, and begins with the first file again.
  void choose(const std::function<bool(const bag::Channel&)>& wanted);

  /// Does what McapReader::next() does, file after file.
  [[nodiscard]] bool next(bag::Message& message);

  /// The channel of the message that next() gave last.
  [[nodiscard]] const bag::Channel& channel_of(const bag::Message& message) const {
    return parts_[at_].reader->channel_of(message);
  }

  /// What was lost of a file and was not reported yet, with the file's name.
  [[nodiscard]] std::optional<std::string> next_loss();

 private:
  struct Part {
    std::string file;
    std::unique_ptr<bag::McapReader> reader;
    std::size_t reported = 0;  // losses
  };

  std::vector<Part> parts_;
  std::vector<bag::Channel> channels_;
  std::size_t at_ = 0;  // the part that is read
};

}  // namespace palpate::sensor
