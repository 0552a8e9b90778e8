#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dds/endpoint.hpp"
#include "device/drivers.hpp"
#include "message/transforms.hpp"

namespace palpate::device {

// Rotations from a node's axes, for poses and for forces, to ours (x right, y away from the
// operator, z up).
struct RosAxes {
  Eigen::Matrix3d poses = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d forces = Eigen::Matrix3d::Identity();
};

/// Newest reading of the hand, in the node's axes.
struct RosReading {
  DeviceState state;
  std::optional<double> stamp;  // s, system time; unset: the message has none
  bool has_velocity = false;    // a new one, since it was last false
};

class RosInput {
 public:
  virtual ~RosInput() = default;
  // Takes what is new; false: nothing was.
  virtual bool take(RosReading& reading) = 0;
  virtual bool wait(double timeout) = 0;
  [[nodiscard]] virtual std::size_t writers() const = 0;
};

template <message::Message T>
class RosTopicInput final : public RosInput {
 public:
  using Put = std::function<void(const T&, RosReading&)>;

  RosTopicInput(const dds::Participant& participant, const std::string& topic, Put put,
                bool reliable = false)
      : reader_(participant, topic, dds::Quality{.reliable = reliable, .depth = 1}),
        put_(std::move(put)) {}

  bool take(RosReading& reading) override {
    bool any = false;
    while (reader_.take(message_)) {
      put_(message_, reading);
      any = true;
    }
    return any;
  }
  bool wait(double timeout) override { return reader_.wait(timeout); }
  [[nodiscard]] std::size_t writers() const override { return reader_.writers(); }

 private:
  dds::Reader<T> reader_;
  Put put_;
  T message_;
};

/// The topics by which a device that a node of ROS 2 owns is spoken to.
struct RosLink {
  explicit RosLink(const dds::DomainOptions& options) : participant(options) {}

  template <message::Message T>
  void on_pose(const std::string& topic, typename RosTopicInput<T>::Put put) {
    pose = std::make_unique<RosTopicInput<T>>(participant, topic, std::move(put));
    pose_topic = topic;
  }
  template <message::Message T>
  void on(const std::string& topic, typename RosTopicInput<T>::Put put) {
    others.push_back(std::make_unique<RosTopicInput<T>>(participant, topic, std::move(put)));
  }
  // Some nodes report buttons only when they change: no message may be lost.
  template <message::Message T>
  void on_buttons(const std::string& topic, typename RosTopicInput<T>::Put put) {
    buttons = std::make_unique<RosTopicInput<T>>(participant, topic, std::move(put), true);
  }
  template <message::Message T>
  void force_to(const std::string& topic, std::function<void(const Wrench&, T&)> put) {
    auto writer = std::make_shared<dds::Writer<T>>(participant, topic,
                                                   dds::Quality{.reliable = true, .depth = 1});
    write = [writer, put = std::move(put), message = T{}](const Wrench& wrench) mutable {
      put(wrench, message);
      if constexpr (requires { message.header; })
        message.header.stamp = message::to_time(message::system_now());
      return writer->write(message);
    };
    listened = [writer] { return writer->readers() > 0; };
    force_topic = topic;
  }

  dds::Participant participant;
  std::unique_ptr<RosInput> pose;
  std::unique_ptr<RosInput> buttons;  // null: there are none
  std::vector<std::unique_ptr<RosInput>> others;
  std::function<bool(const Wrench&)> write;  // in the node's axes for forces
  std::function<bool()> listened;
  std::string pose_topic;
  std::string force_topic;
  RosAxes axes;
  bool takes_torque = false;  // the node's message has a place for it
};

/// Subscribes and publishes as the preset `name.device` requires (docs/ros2.md).
/// @throws Error when there is none of that name, or an option is missing.
void set_up(RosLink& link, const DeviceName& name);

}  // namespace palpate::device
