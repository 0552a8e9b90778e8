// Depth images and clouds of ROS 2, over DDS.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <variant>

#include "dds/discovery.hpp"
#include "dds/endpoint.hpp"
#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/ros_frames.hpp"
#include "sensor/topic_options.hpp"

namespace palpate::sensor {
namespace {

using dds::Quality;
using dds::Reader;
using message::CompressedImage;
using message::Header;
using message::Image;
using message::PointCloud2;
using message::TFMessage;
using message::Transforms;

constexpr double kOldest = 10;          // s; older stamps are from another clock (judgement)
constexpr double kNewest = -0.5;        // s; so are later ones (streams refuse 1 s; judgement)
constexpr double kTransformWait = 0.1;  // s that a frame waits for its transform (judgement)
constexpr double kLook = 0.05;          // s between checks for a publisher (judgement)
constexpr const char* kNoneArrived =
    " has a publisher, but none of its images arrives; where the network loses packets, take its "
    "compressedDepth topic (docs/ros2.md, \"Several machines\")";
constexpr const char* kLost =
    "an image was lost on its way; a larger receive buffer or compressedDepth may help "
    "(docs/ros2.md, \"Several machines\")";
constexpr Quality kSensor{.reliable = false, .depth = 2};
constexpr Quality kTf{.reliable = true, .depth = 100};
constexpr Quality kTfStatic{.reliable = true, .depth = 100, .stays = true};

struct CameraName {
  std::string topic;
  TopicOptions options;
};

CameraName parse(const std::string& name) {
  const std::size_t comma = std::min(name.find(','), name.size());
  const std::string topic = name.substr(0, comma);
  if (!topic.starts_with('/'))
    throw Error(fmt::format("ros:{}: names of topics begin with '/'", name));
  return {topic, parse_topic_options(std::string_view(name).substr(comma), "ros:" + topic)};
}

// Collects transforms from /tf and /tf_static.
class TransformListener {
 public:
  explicit TransformListener(const dds::Participant& participant)
      : moving_(participant, "/tf", kTf), static_(participant, "/tf_static", kTfStatic) {}

  const Transforms& newest() {
    take(static_, true);
    take(moving_, false);
    return transforms_;
  }

  void wait(double timeout) const { moving_.wait(timeout); }

 private:
  void take(Reader<TFMessage>& reader, bool is_static) {
    TFMessage message;
    for (bool more = true; more;) {
      try {
        more = reader.take(message);
        if (more) transforms_.add(message, is_static);
      } catch (const Error&) {
        // A damaged message does not report where frames are; the next one comes soon.
      }
    }
  }

  Reader<TFMessage> moving_;
  Reader<TFMessage> static_;
  Transforms transforms_;
};

class RosCamera final : public DepthCamera {
 public:
  RosCamera(const std::string& name, const Clock* clock)
      : name_(parse(name)),
        frames_(name_.topic, name_.options.unit),
        info_{.name = "ros:" + name_.topic, .rate = 30, .paces = true, .repeats = true},
        clock_(clock != nullptr ? *clock : host_),
        participant_(dds::environment_options()) {
    if (!name_.options.frame.empty()) transforms_.emplace(participant_);
    // Reports at once when the topic's name is invalid.
    infos_.emplace(participant_, frames_.info_topic(), kSensor);
  }

  [[nodiscard]] const palpate::CameraInfo& info() const noexcept override { return info_; }
  [[nodiscard]] std::string reason() const override { return reason_; }
  [[nodiscard]] DepthCamera::Status read(DepthFrame& frame, double timeout) override;

 private:
  using Images =
      std::variant<std::monostate, std::unique_ptr<Reader<Image>>,
                   std::unique_ptr<Reader<CompressedImage>>, std::unique_ptr<Reader<PointCloud2>>>;

  [[nodiscard]] std::size_t writers() const;
  bool connect();
  void take_infos();
  template <class Message>
  DepthCamera::Status take(Reader<Message>& reader, DepthFrame& frame, double timeout);
  [[nodiscard]] double stamp_of(const Header& header) const;
  bool set_pose(const Header& header, DepthFrame& frame);

  CameraName name_;
  RosFrames frames_;
  palpate::CameraInfo info_;
  SteadyClock host_;
  const Clock& clock_;
  dds::Participant participant_;
  std::optional<TransformListener> transforms_;
  std::optional<Reader<message::CameraInfo>> infos_;
  Images images_;
  bool arrived_ = false;    // a message
  std::uint64_t lost_ = 0;  // messages that never arrived, as far as they were reported
  std::string reason_;
};

std::size_t RosCamera::writers() const {
  return std::visit(
      [](const auto& reader) -> std::size_t {
        if constexpr (std::is_same_v<decltype(reader), const std::monostate&>) {
          return 0;
        } else {
          return reader->writers();
        }
      },
      images_);
}

// Once there is a publisher, its type decides what is read.
bool RosCamera::connect() {
  if (arrived_ && writers() == 0) images_ = {};  // the next publisher's type may be another
  if (!std::holds_alternative<std::monostate>(images_)) return true;
  arrived_ = false;
  lost_ = 0;
  std::string other;
  for (const dds::Endpoint& there : dds::endpoints(participant_)) {
    if (!there.writes || there.topic != name_.topic) continue;
    const auto make = [&]<class Message>(std::unique_ptr<Reader<Message>> none) {
      if (there.type != Message::kName) return false;
      none = std::make_unique<Reader<Message>>(participant_, name_.topic, kSensor);
      images_ = std::move(none);
      return true;
    };
    if (make(std::unique_ptr<Reader<Image>>()) ||
        make(std::unique_ptr<Reader<CompressedImage>>()) ||
        make(std::unique_ptr<Reader<PointCloud2>>())) {
      return true;
    }
    other = there.type;
  }
  reason_ =
      other.empty()
          ? fmt::format("no node publishes {}; 'palpate ros' lists what is there", name_.topic)
          : fmt::format(
                "{} has type {}; depth comes as sensor_msgs Image, CompressedImage or "
                "PointCloud2",
                name_.topic, other);
  return false;
}

DepthCamera::Status RosCamera::read(DepthFrame& frame, double timeout) {
  reason_.clear();
  for (const double end = clock_.now() + timeout; !connect();) {
    const double left = end - clock_.now();
    if (left <= 0) return DepthCamera::Status::waiting;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, kLook)));
  }
  reason_.clear();
  return std::visit(
      [&](auto& reader) {
        if constexpr (std::is_same_v<decltype(reader), std::monostate&>) {
          return DepthCamera::Status::waiting;
        } else {
          return take(*reader, frame, timeout);
        }
      },
      images_);
}

template <class Message>
DepthCamera::Status RosCamera::take(Reader<Message>& reader, DepthFrame& frame, double timeout) {
  if (lost_ < reader.lost()) {
    ++lost_;
    reason_ = kLost;
    return DepthCamera::Status::damaged;
  }
  if (!reader.wait(timeout)) {
    if (!arrived_) reason_ = name_.topic + kNoneArrived;
    return DepthCamera::Status::waiting;
  }
  arrived_ = true;
  take_infos();
  try {
    Message message;
    if (!reader.take(message)) return DepthCamera::Status::waiting;
    frames_.fill(message, frame);
    frame.stamp = stamp_of(message.header);
    return set_pose(message.header, frame) ? DepthCamera::Status::frame
                                           : DepthCamera::Status::unposed;
  } catch (const Error& error) {
    reason_ = error.what();
    return DepthCamera::Status::damaged;
  }
}

void RosCamera::take_infos() {
  message::CameraInfo info;
  for (bool more = true; more;) {
    try {
      more = infos_->take(info);
      if (more) frames_.set_camera(info);
    } catch (const Error& error) {
      frames_.lose_camera(error.what());
    }
  }
}

double RosCamera::stamp_of(const Header& header) const {
  const double now = clock_.now();
  const double age = message::system_now() - to_seconds(header.stamp);
  return age < kOldest && age > kNewest ? now - age : now;
}

bool RosCamera::set_pose(const Header& header, DepthFrame& frame) {
  frame.T_world_sensor.reset();
  if (!transforms_) return true;
  const double stamp = to_seconds(header.stamp);
  // Counted from the stamp: an image that waited already does not keep the next ones waiting.
  for (const double end = frame.stamp + kTransformWait; !frame.T_world_sensor;) {
    frame.T_world_sensor =
        transforms_->newest().find(name_.options.frame, header.frame_id, stamp, &reason_);
    const double left = end - clock_.now();
    if (frame.T_world_sensor || left <= 0) break;
    transforms_->wait(std::min(left, 0.01));
  }
  if (frame.T_world_sensor) reason_.clear();
  return frame.T_world_sensor.has_value();
}

}  // namespace

DriverInfo ros_driver() {
  return {.name = "ros",
          .description =
              "topics of ROS 2: ros:TOPIC[,frame=FRAME][,unit=METRES] ('palpate ros' lists them)",
          .missing = {},
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_ros(const std::string& name, const CameraOptions& options) {
  return std::make_unique<RosCamera>(name, options.clock);
}

}  // namespace palpate::sensor
