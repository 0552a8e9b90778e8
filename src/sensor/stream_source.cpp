// Apart, so that a stream into another sink needs no Source.
#include <fmt/format.h>

#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"

namespace palpate {
namespace {

Stream::Sink sink_of(Source& source) {
  return [&source](const DepthFrame& frame, const StartTime& start) {
    if (source.push(frame, start)) return;
    throw Error(
        fmt::format("all snapshots are held by fields that are not updated, e.g. that of {}. "
                    "Update or close it",
                    source.state().slowest));
  };
}

}  // namespace

Stream::Stream(DepthCamera& camera, Source& source, const Clock& clock,
               const StreamOptions& options)
    : Stream(camera, source.name(), sink_of(source), clock, options, [&source] { source.keep(); }) {
}

SimulatedStream::SimulatedStream(DepthCamera& camera, Source& source,
                                 const SimulatedStreamOptions& options)
    : SimulatedStream(camera, source.name(), sink_of(source), options,
                      [&source] { source.keep(); }) {}

}  // namespace palpate
