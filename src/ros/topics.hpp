// The topics of a bridge.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "dds/endpoint.hpp"
#include "ros/hand_messages.hpp"
#include "ros/robot_target.hpp"

namespace palpate::ros {

inline constexpr dds::Quality kReported{.reliable = true, .depth = 1};
inline constexpr dds::Quality kNewest{.reliable = false, .depth = 1};

/// The names that others gave to topics, and those of them that no topic has.
struct TopicNames {
  const std::map<std::string, std::string>& given;
  std::map<std::string, std::string> unused = given;

  std::string operator()(const std::string& name) {
    unused.erase(name);
    const auto found = given.find(name);
    return found == given.end() ? name : found->second;
  }
};

/// A topic with its own rate.
template <class T>
struct PacedTopic {
  dds::Writer<T> writer;
  Every due;
};

/// The topics of one hand.
struct HandTopics {
  HandTopics(const dds::Participant& with, RosBridge::Hand its_hand,
             const std::function<std::string(const std::string&)>& name)
      : hand(std::move(its_hand)),
        pose(with, name("pose"), kReported),
        proxy(with, name("proxy"), kReported),
        twist(with, name("twist"), kReported),
        wrench(with, name("wrench"), kReported),
        joy(with, name("joy"), kReported),
        measured_cp(with, name("measured_cp"), kReported),
        measured_cv(with, name("measured_cv"), kReported),
        measured_cf(with, name("measured_cf"), kReported),
        servo_cf(with, name("servo_cf"), kNewest) {}

  void tell(const message::Header& header, const ServoState& state) {
    const message::PoseStamped position = hand_pose(header, state);
    const message::TwistStamped velocity = hand_twist(header, state);
    const message::WrenchStamped force = hand_wrench(header, state);
    pose.write(position);
    measured_cp.write(position);
    proxy.write(proxy_pose(header, state));
    twist.write(velocity);
    measured_cv.write(velocity);
    wrench.write(force);
    measured_cf.write(force);
    joy.write(hand_joy(header, state));
  }

  RosBridge::Hand hand;
  StepDurations reported = {};  // what was published already
  dds::Writer<message::PoseStamped> pose;
  dds::Writer<message::PoseStamped> proxy;
  dds::Writer<message::TwistStamped> twist;
  dds::Writer<message::WrenchStamped> wrench;
  dds::Writer<message::Joy> joy;
  dds::Writer<message::PoseStamped> measured_cp;
  dds::Writer<message::TwistStamped> measured_cv;
  dds::Writer<message::WrenchStamped> measured_cf;
  dds::Reader<message::WrenchStamped> servo_cf;
};

}  // namespace palpate::ros
