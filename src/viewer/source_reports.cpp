#include "viewer/source_reports.hpp"

#include <algorithm>

namespace palpate::viewer {
namespace {

const ViewerStream* stream_of(std::span<const ViewerStream> streams, const std::string& source) {
  const auto found = std::ranges::find_if(
      streams, [&](const ViewerStream& stream) { return stream.state.source == source; });
  return found == streams.end() ? nullptr : &*found;
}

void add_stream(const ViewerStream& stream, const Source& source, const Eigen::Vector3d& origin,
                SourceReport& report) {
  report.rate = stream.state.rate;
  report.dropped += stream.state.drops.total();
  report.frustum = stream.frustum;
  Eigen::Isometry3d pose = stream.T_world_sensor.value_or(source.pose());
  pose.translation() -= origin;
  report.pose = pose;
}

}  // namespace

std::vector<SourceReport> source_reports(const Scene& scene, std::span<const ViewerStream> streams,
                                         const Eigen::Vector3d& origin, double now) {
  std::vector<SourceReport> reports;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    const SourceState state = scene.state(i);
    const ViewerStream* stream = stream_of(streams, source.name());
    const auto points = source.points();
    SourceReport report;
    report.name = source.name();
    report.phase = in_words(stream != nullptr ? &stream->state : nullptr);
    report.rate = state.rate();
    report.points = points ? points->size() : 0;
    report.latency = state.latency;
    if (state.frames > 0) report.age = now - state.stamp;
    report.dropped = state.dropped;
    report.disagreement = state.disagreement;
    if (stream != nullptr) add_stream(*stream, source, origin, report);
    reports.push_back(std::move(report));
  }
  return reports;
}

}  // namespace palpate::viewer
