#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/sources/loaded_scene.hpp"
#include "bag/mcap_writer.hpp"
#include "message/display_types.hpp"
#include "message/geometry_types.hpp"
#include "message/palpate_types.hpp"
#include "palpate/servo/servo.hpp"
#include "servo/step_trace.hpp"
#include "session/recorded_messages.hpp"

namespace palpate::app {

/// State of a robot that follows the tool, from a time on.
struct RecordedRobot {
  double time = 0;  ///< s, on the run's clock
  message::DiagnosticStatus status;
};

/// Copy of a run's set-up at a moment.
struct RecordedSetup {
  Json json;
  std::int64_t epoch = 0;  ///< when the run's clock was 0, ns since 1970
  /// One for each source; null for cameras.
  std::vector<std::shared_ptr<const PointCloud>> clouds;
  std::vector<std::shared_ptr<const DepthFrame>> images;
};

/// With the settings that hold now.
[[nodiscard]] RecordedSetup setup_of(const LoadedScene& loaded,
                                     const std::vector<const Servo*>& servos, std::int64_t epoch);

/// The messages of a run in an MCAP file. One thread. Every function throws Error when the file
/// cannot be written.
class RecordingFile {
 public:
  explicit RecordingFile(const std::string& path) : writer_(path) {}

  /// Writes what the run is made of.
  void begin(const RecordedSetup& setup);

  void write(std::size_t hand, const StepTrace& step);
  void write(const session::RecordedFrame& recorded);
  void write(const RecordedRobot& recorded);

  /// Everything is there.
  void close() { writer_.close(); }

 private:
  struct HandTopics {
    std::string name;
    std::uint16_t tick, change, pose, proxy, wrench, joy;
    std::optional<std::uint16_t> tool;  // of one that turns
    double shown = -1e300;              // last message but ticks, s
  };
  struct SourceTopics {
    std::string name;
    std::uint16_t use, image, info, points, cloud;
    double time = 0;  // of its last message, s
  };

  void add_hand(const std::string& topic, bool turns);
  void add_source(const std::string& topic, bool lives);
  void attach(const std::string& name, const bag::Bytes& bytes, const char* type);
  template <class T>
  void put(std::uint16_t channel, double time, const T& message);
  [[nodiscard]] message::Header header(double time, const std::string& frame) const;
  void show(HandTopics& hand, const ServoState& state);
  void change(const HandTopics& hand, const ServoState& state, const char* what, const Json& value);

  bag::McapWriter writer_;
  std::int64_t epoch_ = 0;
  std::vector<HandTopics> hands_;
  std::vector<SourceTopics> live_;  // by source
  std::uint16_t transforms_ = 0;
  std::optional<std::uint16_t> robot_ = {};
};

/// A topic's last part: "hand" of "/palpate/hand".
[[nodiscard]] std::string last_part(const std::string& topic);

}  // namespace palpate::app
