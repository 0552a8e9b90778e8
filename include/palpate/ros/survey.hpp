#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

/// A topic of ROS 2 as others see it, and what palpate can do with it.
struct RosTopic {
  std::string name;  ///< "/camera/depth/image_rect_raw"
  std::string type;  ///< "sensor_msgs/Image"
  int writers = 0;
  int readers = 0;
  bool reliable = false;  ///< of all its writers; without one, of its readers
  double rate = 0;        ///< messages a second, Hz; 0: not measured, or none came
  std::string frame;      ///< frame of reference that its messages name; empty: unknown
  std::string
      use;  ///< what to write to use it, such as "palpate touch ros:/camera/depth"; empty: none
  std::string mismatch;  ///< why palpate and it would not understand one another; empty: they would
};

/// Looks for `seconds` s at what is on ROS 2 and listens to what can be used. The environment sets
/// in which domain and how far. Any thread but a servo's.
/// @throws Error when DDS fails, or the build has none.
[[nodiscard]] std::vector<RosTopic> survey_ros(double seconds);

}  // namespace palpate
