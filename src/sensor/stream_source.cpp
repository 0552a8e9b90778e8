// Apart, so that a stream into another sink needs no Source.
#include <utility>

#include "palpate/sensor/stream.hpp"

namespace palpate {
namespace {

FrameSink sink_of(Source& source) {
  return [&source](const DepthFrame& frame, const StartTime& start) { source.push(frame, start); };
}

}  // namespace

Stream::Stream(std::unique_ptr<DepthCamera> camera, Source& source, const Clock& clock,
               const StreamOptions& options)
    : Stream(std::move(camera), source.name(), sink_of(source), clock, options) {}

}  // namespace palpate
