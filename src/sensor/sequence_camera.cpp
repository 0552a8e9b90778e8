// Plays a sequence of depth images or clouds from a folder as a camera.
#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "sensor/played_camera.hpp"
#include "sensor/sequence.hpp"

namespace palpate::sensor {
namespace {

// The images of a sequence: see open_sequence().
class SequenceRecording final : public Recording {
 public:
  explicit SequenceRecording(Sequence sequence)
      : sequence_(std::move(sequence)),
        images_{.camera = sequence_.camera,
                .depth_unit = sequence_.depth_unit,
                .invalid = sequence_.invalid,
                .swapped = sequence_.swapped} {}

  void rewind() override { next_ = 0; }
  [[nodiscard]] DepthCamera::Status next(DepthFrame& frame, double& time,
                                         std::string& why) override;

 private:
  void read(const std::filesystem::path& path, DepthFrame& frame);

  Sequence sequence_;
  ReadDepthOptions images_;
  std::size_t next_ = 0;
};

void SequenceRecording::read(const std::filesystem::path& path, DepthFrame& frame) {
  if (is_cloud(path)) {
    frame.cloud = std::make_shared<const PointCloud>(read_cloud(path));
    return;
  }
  frame.cloud.reset();
  read_depth_frame(path, images_, frame);
  // The first image sets what size all have, where the description does not.
  images_.camera.width = frame.camera.width;
  images_.camera.height = frame.camera.height;
}

DepthCamera::Status SequenceRecording::next(DepthFrame& frame, double& time, std::string& why) {
  if (next_ == sequence_.frames.size()) return DepthCamera::Status::ended;
  const SequenceFrame& recorded = sequence_.frames[next_++];
  time = recorded.stamp - sequence_.frames.front().stamp;
  if (sequence_.posed && !recorded.T_world_sensor) {
    why = fmt::format("{}: it has no pose, but other frames have one. It was skipped.",
                      recorded.image.string());
    return DepthCamera::Status::unposed;
  }
  try {
    read(recorded.image, frame);
  } catch (const Error& error) {
    why = error.what();
    return DepthCamera::Status::damaged;
  }
  frame.T_world_sensor = recorded.T_world_sensor;
  return DepthCamera::Status::frame;
}

}  // namespace
}  // namespace palpate::sensor

namespace palpate {

std::unique_ptr<DepthCamera> open_sequence(Sequence sequence, const SequenceOptions& options) {
  if (sequence.frames.empty()) {
    throw Error(
        fmt::format("{}: the sequence has no frames. Add 16-bit depth images (PNG, PGM) or clouds "
                    "(PCD, PLY).",
                    sequence.name));
  }
  CameraInfo info{.name = "sequence:" + sequence.name,
                  .rate = sequence.rate,
                  .repeats = options.loop && sequence.frames.size() == 1,
                  .assumed = sequence.assumed};
  return std::make_unique<sensor::PlayedCamera>(
      std::move(info), std::make_unique<sensor::SequenceRecording>(std::move(sequence)),
      CameraOptions{.clock = options.clock, .loop = options.loop});
}

}  // namespace palpate
