#pragma once

#include <string>
#include <vector>

#include "dds/domain.hpp"

namespace palpate::dds {

/// A writer or reader of a ROS topic that somebody has, this process included.
struct Endpoint {
  std::string topic;  ///< "/camera/depth"
  std::string type;   ///< "sensor_msgs/Image"; a type that is none of ROS's as it is named on DDS
  std::string hash;   ///< "RIHS01_..."; empty: it sends none
  bool writes = false;
  bool reliable = false;
  bool stays = false;  ///< transient local
};

/// Endpoints discovered so far, by topic; discovery takes a second or so. Leaves out the topics of
/// ROS's services and actions. Any thread but a servo's.
[[nodiscard]] std::vector<Endpoint> endpoints(const Participant& participant);

}  // namespace palpate::dds
