// Depth images and clouds of anybody's bags.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "sensor/bag_images.hpp"
#include "sensor/bag_topics.hpp"
#include "sensor/live_camera.hpp"
#include "sensor/played_camera.hpp"
#include "sensor/ros_frames.hpp"

namespace palpate::sensor {
namespace {

using bag::Channel;
using message::Header;
using message::TFMessage;
using Status = DepthCamera::Status;

// ns that an image waits for its transform (judgement)
constexpr std::uint64_t kLateTransform = 100'000'000;
constexpr int kMeasured = 30;         // images that give the rate (judgement)
constexpr double kSlowestBag = 0.1;   // Hz (judgement)
constexpr double kFastestBag = 1000;  // Hz (judgement)
constexpr int kInfos = 10;            // camera infos tried until one can be used (judgement)
constexpr int kStatics = 1000;        // messages of static transforms that are read (judgement)

// Decodes a message of type T and makes a frame of it.
template <class T>
void fill_from(const RosFrames& frames, bag::View data, DepthFrame& frame) {
  T message;
  decode(data, message);
  frames.fill(message, frame);
}

// What the first images show of the others.
struct BagRate {
  double rate = 30;  // Hz
  bool one_image = false;
};

// The images or clouds of one topic, as open_bag() describes. An image whose transform is not there
// yet waits until the file is read 0.1 s further; no more than that is held.
class BagRecording final : public Recording {
 public:
  explicit BagRecording(const BagName& name);

  [[nodiscard]] const std::string& topic() const { return frames_.topic(); }
  [[nodiscard]] const BagRate& rate() const { return rate_; }

  void rewind() override;
  [[nodiscard]] Status next(DepthFrame& frame, double& time, std::string& why) override;

 private:
  [[nodiscard]] bool is_image(const Channel& channel) const {
    return channel.topic == frames_.topic() && may_be_felt(channel);
  }
  [[nodiscard]] bool is_info(const Channel& channel) const {
    return channel.topic == frames_.info_topic() && holds<message::CameraInfo>(channel);
  }
  void measure();
  void learn_camera();
  void learn_what_stands_still();
  void read_ahead();
  void take(const bag::Message& message);
  void keep(const Channel& channel, const bag::Message& message);
  [[nodiscard]] bool is_ready(const BagImage& image) const;
  [[nodiscard]] Status show(const BagImage& image, DepthFrame& frame, std::string& why);

  std::string file_;
  SplitBag reader_;
  RosFrames frames_;
  std::string frame_;
  std::optional<std::string>
      first_frame_;  // of the first image, which others share without `frame_`
  BagRate rate_;
  message::Transforms still_;  // wherever in the file they are recorded
  message::Transforms transforms_;
  WaitingImages waiting_;
  ImageTimes times_;
  std::uint64_t log_ = 0;  // how far the file was read, ns
  bool read_ = false;      // to its end
};

BagRecording::BagRecording(const BagName& name)
    : file_(name.file),
      reader_(name.files),
      frames_(topic_of(reader_, name), name.options.unit),
      frame_(name.options.frame) {
  measure();
  learn_camera();
  learn_what_stands_still();
  BagRecording::rewind();
}

// Measures the frame rate from the first images.
void BagRecording::measure() {
  reader_.choose([&](const Channel& channel) { return is_image(channel); });
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  int count = 0;
  for (bag::Message found; count < kMeasured && reader_.next(found); ++count) {
    last = found.stamp.log;
    if (count == 0) first = last;
  }
  if (count == 0) throw Error(fmt::format("{}: no message is left on {}", file_, topic()));
  rate_.one_image = count == 1;
  if (last == first) return;
  rate_.rate = std::clamp((count - 1) / (kNanosecond * static_cast<double>(last - first)),
                          kSlowestBag, kFastestBag);
}

// So that the first images have a camera, which is often recorded a little later.
void BagRecording::learn_camera() {
  const auto is_picture = [&](const Channel& channel) {
    return is_image(channel) && !holds<message::PointCloud2>(channel);
  };
  if (std::ranges::none_of(reader_.channels(), is_picture)) return;
  reader_.choose([&](const Channel& channel) { return is_info(channel); });
  std::string why = fmt::format("there is no CameraInfo; record it with {}", topic());
  int tried = 0;
  for (bag::Message found; tried < kInfos && reader_.next(found); ++tried) {
    try {
      message::CameraInfo info;
      decode(found.data, info);
      static_cast<void>(camera_of(info, message::is_rectified(topic())));
      return frames_.set_camera(info);
    } catch (const Error& error) {
      why = error.what();
    }
  }
  throw Error(fmt::format("{}: {}: {}", file_, frames_.info_topic(), why));
}

void BagRecording::learn_what_stands_still() {
  if (frame_.empty()) return;
  reader_.choose([](const Channel& channel) {
    return holds<TFMessage>(channel) && channel.topic.ends_with("tf_static");
  });
  int count = 0;
  for (bag::Message found; count < kStatics && reader_.next(found); ++count) take(found);
  still_ = std::exchange(transforms_, {});
}

void BagRecording::rewind() {
  reader_.choose([&](const Channel& channel) {
    return is_image(channel) || is_info(channel) || (!frame_.empty() && holds<TFMessage>(channel));
  });
  transforms_ = still_;
  waiting_ = {};
  times_ = {};
  log_ = 0;
  read_ = false;
}

Status BagRecording::next(DepthFrame& frame, double& time, std::string& why) {
  time = times_.last();
  try {
    read_ahead();
  } catch (const Error& error) {
    read_ = true;
    why = error.what();
    return Status::damaged;
  }
  if (const auto loss = reader_.next_loss()) {
    why = *loss;
    return Status::damaged;
  }
  if (waiting_.empty()) return Status::ended;
  const BagImage image = waiting_.pop();
  time = times_.next(to_seconds(image.header.stamp), image.log);
  return show(image, frame, why);
}

void BagRecording::read_ahead() {
  while (!read_ && (waiting_.empty() || !is_ready(waiting_.front()))) {
    bag::Message found;
    read_ = !reader_.next(found);
    if (!read_) take(found);
  }
}

bool BagRecording::is_ready(const BagImage& image) const {
  if (frame_.empty() || log_ - image.log > kLateTransform) return true;
  if (waiting_.full()) return true;
  return transforms_.find(frame_, image.header.frame_id, to_seconds(image.header.stamp))
      .has_value();
}

void BagRecording::take(const bag::Message& message) {
  log_ = message.stamp.log;
  const Channel& channel = reader_.channel_of(message);
  if (is_image(channel)) return keep(channel, message);
  try {
    if (is_info(channel)) {
      message::CameraInfo info;
      decode(message.data, info);
      frames_.set_camera(info);
    } else {
      TFMessage transforms;
      decode(message.data, transforms);
      transforms_.add(transforms, channel.topic.ends_with("tf_static"));
    }
  } catch (const Error&) {
    // A damaged message is left out; the next one comes soon.
  }
}

void BagRecording::keep(const Channel& channel, const bag::Message& message) {
  BagImage image;
  image.fill = fill_from<message::Image>;
  image.log = message.stamp.log;
  image.data.assign(message.data.begin(), message.data.end());
  if (holds<message::CompressedImage>(channel)) image.fill = fill_from<message::CompressedImage>;
  if (holds<message::PointCloud2>(channel)) image.fill = fill_from<message::PointCloud2>;
  try {
    message::CdrReader(message.data).get(image.header);
  } catch (const Error&) {
    image.header = {};  // what is damaged is reported when its turn comes
  }
  waiting_.push(std::move(image));
}

Status BagRecording::show(const BagImage& image, DepthFrame& frame, std::string& why) {
  try {
    image.fill(frames_, image.data, frame);
  } catch (const Error& error) {
    why = error.what();
    return Status::damaged;
  }
  frame.T_world_sensor.reset();
  const Header& header = image.header;
  if (frame_.empty()) {
    if (!first_frame_) first_frame_ = header.frame_id;
    if (header.frame_id == *first_frame_) return Status::frame;
    why = fmt::format(
        "it is in the frame \"{}\", and the first one in \"{}\"; ,frame=FRAME behind "
        "the source's name brings both into one, by /tf",
        header.frame_id, *first_frame_);
    return Status::unposed;
  }
  frame.T_world_sensor = transforms_.find(frame_, header.frame_id, to_seconds(header.stamp), &why);
  return frame.T_world_sensor ? Status::frame : Status::unposed;
}

}  // namespace

DriverInfo bag_driver() {
  return {.name = "bag",
          .description =
              "bags of ROS 2 (MCAP): bag:FILE[:TOPIC][,frame=FRAME][,unit=METRES] (docs/bags.md)",
          .missing = {},
          .devices = {}};
}

std::unique_ptr<DepthCamera> open_bag(const std::string& name, const CameraOptions& options) {
  auto recording = std::make_unique<BagRecording>(parse_bag_name(name));
  CameraInfo info{.name = "bag:" + name,
                  .rate = recording->rate().rate,
                  .repeats = options.loop && recording->rate().one_image};
  return std::make_unique<PlayedCamera>(std::move(info), std::move(recording), options);
}

}  // namespace palpate::sensor
