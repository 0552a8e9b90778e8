#pragma once

#include <string>
#include <vector>

#include "bag/mcap_format.hpp"
#include "message/schema.hpp"
#include "message/sensor_types.hpp"
#include "sensor/split_bag.hpp"
#include "sensor/topic_options.hpp"

namespace palpate::sensor {

/// Parts of "FILE[:TOPIC][,frame=FRAME][,unit=METRES]".
struct BagName {
  std::string file;                ///< or folder, for messages
  std::vector<std::string> files;  ///< that are read, in this order
  std::string topic;               ///< empty: the one that fits
  TopicOptions options;
};

/// The file or folder that such a name begins with. One whose name looks like more is taken for
/// what it is.
[[nodiscard]] std::string bag_file(const std::string& name);

/// The files of a recording: of a folder, as ROS 2 records into, the MCAP files that its
/// metadata.yaml lists or, without one, the only one in it, or a recording of another kind.
/// @throws Error when there are none, or several and none is named.
[[nodiscard]] std::vector<std::string> recorded_files(const std::string& path);

/// @throws Error as recorded_files() and parse_topic_options() do.
[[nodiscard]] BagName parse_bag_name(const std::string& name);

/// Are these messages of T, in ROS 2's encoding?
template <message::Message T>
[[nodiscard]] bool holds(const bag::Channel& channel) {
  return channel.message_encoding == "cdr" && channel.schema.name == message::ros_name(T::kName);
}

/// Images, of depth or not, or clouds.
[[nodiscard]] inline bool may_be_felt(const bag::Channel& channel) {
  return holds<message::Image>(channel) || holds<message::CompressedImage>(channel) ||
         holds<message::PointCloud2>(channel);
}

/// The topic that is named; else the only one of depth images, else the only one of clouds. What
/// the reader gives next is afterwards anything.
/// @throws Error when there is no such topic, or several; it lists those that fit.
[[nodiscard]] std::string topic_of(SplitBag& reader, const BagName& name);

}  // namespace palpate::sensor
