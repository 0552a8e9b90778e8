#pragma once

#include <optional>
#include <string>

#include "palpate/io/read_depth.hpp"
#include "palpate/sensor/sequence.hpp"

namespace palpate::sensor {

/// Plays a sequence. See open_sequence().
class SequenceCamera final : public DepthCamera {
 public:
  SequenceCamera(Sequence sequence, const SequenceOptions& options);

  [[nodiscard]] const CameraInfo& info() const noexcept override { return info_; }
  void begin(double start) override;
  [[nodiscard]] CameraStatus read(DepthFrame& frame, double timeout) override;
  [[nodiscard]] std::string reason() const override { return reason_; }

 private:
  void load();
  void load_image(const SequenceFrame& frame);
  [[nodiscard]] double stamp() const;
  [[nodiscard]] bool wait(double timeout) const;
  [[nodiscard]] CameraStatus show(DepthFrame& frame);

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
  CameraStatus status_ = CameraStatus::frame;  // of the loaded frame
  std::string failure_;                        // why it is not good
  DepthFrame loaded_frame_;
};

}  // namespace palpate::sensor
