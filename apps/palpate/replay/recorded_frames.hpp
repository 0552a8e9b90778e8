#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "bag/mcap_reader.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

/// The attachment of that name. @throws Error when the file has none, or it is damaged.
[[nodiscard]] bag::Attachment attachment_named(const bag::McapReader& reader,
                                               const std::string& name);

/// Makes the surface of a source that stood still, as it was prepared before the run, that of
/// `source`, which has its options. `json`: its part of the set-up, the one at `index`.
void show_surface(const bag::McapReader& reader, std::size_t index, const Json& json,
                  Source& source);

/// Makes what `prepared` shows the surface of `source`, for good.
void publish_surface(const Source& prepared, Source& source);

/// What came to one source of a recorded run, in order, from any moment on. One thread. What is
/// damaged throws Error.
class RecordedFrames {
 public:
  /// `topic`: the source's; `reader`: of the file.
  RecordedFrames(const std::string& path, const bag::McapReader& reader, const std::string& topic);

  /// next() gives what was recorded at `from` (ns since 1970) and after.
  void seek(std::uint64_t from);

  /// The next frame with what became of it; none: there are no more.
  [[nodiscard]] std::optional<RecordedFrame> next();

 private:
  bag::McapReader reader_;
  std::string topic_;
};

}  // namespace palpate::app
