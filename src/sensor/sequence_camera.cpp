#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "palpate/base/error.hpp"
#include "palpate/io/files.hpp"
#include "sensor/sequence.hpp"

namespace palpate::sensor {
namespace {

// Plays a sequence: see open_sequence().
class SequenceCamera final : public DepthCamera {
 public:
  SequenceCamera(Sequence sequence, const SequenceOptions& options);

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override;
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;
  [[nodiscard]] std::string reason() const override { return reason_; }

 private:
  void load();
  void load_image(const SequenceFrame& frame);
  [[nodiscard]] double stamp() const;
  [[nodiscard]] bool wait(double timeout) const;
  [[nodiscard]] DepthCamera::Status show(DepthFrame& frame);

  Sequence sequence_;
  SequenceOptions options_;
  CameraInfo info_;
  ReadDepthOptions images_;
  double lap_ = 0;  // s from the first frame to the first frame of the next lap
  std::string reason_;
  std::optional<double> start_;  // stamp of the first frame, s; unset until it is asked for
  std::size_t next_ = 0;
  std::size_t laps_ = 0;
  bool loaded_ = false;  // the next frame is in loaded_frame_, or failed to get there
  DepthCamera::Status status_ = DepthCamera::Status::frame;  // of the loaded frame
  std::string failure_;                                      // why it is not good
  DepthFrame loaded_frame_;
};

SequenceCamera::SequenceCamera(Sequence sequence, const SequenceOptions& options)
    : sequence_(std::move(sequence)),
      options_(options),
      info_{.name = "sequence:" + sequence_.name,
            .rate = sequence_.rate,
            .paces = options.clock != nullptr,
            .repeats = options.loop && sequence_.frames.size() == 1},
      images_{.camera = sequence_.camera,
              .depth_unit = sequence_.depth_unit,
              .invalid = sequence_.invalid,
              .swapped = sequence_.swapped} {
  if (sequence_.frames.empty()) {
    throw Error(fmt::format("{}: the sequence has no frames. Add 16-bit depth images (PNG, PGM).",
                            sequence_.name));
  }
  lap_ = sequence_.frames.back().stamp - sequence_.frames.front().stamp + 1 / sequence_.rate;
}

void SequenceCamera::begin(double start) {
  start_ = start;
  next_ = 0;
  laps_ = 0;
  loaded_ = false;
}

DepthCamera::Status SequenceCamera::read(DepthFrame& frame, double timeout) {
  reason_.clear();
  if (next_ == sequence_.frames.size()) {
    if (!options_.loop) return DepthCamera::Status::ended;
    next_ = 0;
    ++laps_;
  }
  if (!start_) start_ = options_.clock != nullptr ? options_.clock->now() : 0;
  load();  // beforehand, so that it is there when its time comes
  if (!wait(timeout)) return DepthCamera::Status::waiting;
  return show(frame);
}

double SequenceCamera::stamp() const {
  const double since = sequence_.frames[next_].stamp - sequence_.frames.front().stamp;
  return *start_ + since + static_cast<double>(laps_) * lap_;
}

void SequenceCamera::load() {
  if (std::exchange(loaded_, true)) return;
  load_image(sequence_.frames[next_]);
}

void SequenceCamera::load_image(const SequenceFrame& frame) {
  if (sequence_.posed && !frame.T_world_sensor) {
    status_ = DepthCamera::Status::unposed;
    failure_ = fmt::format("{}: it has no pose, but other frames have one. It was skipped.",
                           frame.image.string());
    return;
  }
  try {
    read_depth_frame(frame.image, images_, loaded_frame_);
  } catch (const Error& error) {
    status_ = DepthCamera::Status::damaged;
    failure_ = error.what();
    return;
  }
  status_ = DepthCamera::Status::frame;
  // The first image says what size all have, where the description does not.
  images_.camera.width = loaded_frame_.camera.width;
  images_.camera.height = loaded_frame_.camera.height;
  loaded_frame_.T_world_sensor = frame.T_world_sensor;
}

bool SequenceCamera::wait(double timeout) const {
  if (options_.clock == nullptr) return true;
  const double early = stamp() - options_.clock->now();
  if (early <= 0) return true;
  if (timeout <= 0) return false;
  std::this_thread::sleep_for(std::chrono::duration<double>(std::min(early, timeout)));
  return options_.clock->now() >= stamp();
}

DepthCamera::Status SequenceCamera::show(DepthFrame& frame) {
  const double time = stamp();
  loaded_ = false;
  ++next_;
  if (status_ != DepthCamera::Status::frame) {
    reason_ = std::exchange(failure_, "");
    return status_;
  }
  std::swap(frame, loaded_frame_);
  frame.stamp = time;
  return DepthCamera::Status::frame;
}

}  // namespace
}  // namespace palpate::sensor

namespace palpate {

std::unique_ptr<DepthCamera> open_sequence(Sequence sequence, const SequenceOptions& options) {
  return std::make_unique<sensor::SequenceCamera>(std::move(sequence), options);
}

}  // namespace palpate
