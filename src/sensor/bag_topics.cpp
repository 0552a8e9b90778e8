// Chooses the topics of a bag that hold depth frames and their camera.
#include "sensor/bag_topics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "io/text_scanner.hpp"
#include "message/depth_images.hpp"
#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

namespace fs = std::filesystem;
using bag::Channel;
using message::CompressedImage;
using message::PointCloud2;

bool is_there(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

// The files that the metadata.yaml of a folder lists as parts of its recording. Older ones have the
// folder's name before theirs.
std::vector<std::string> listed_files(const std::string& folder) {
  std::ifstream metadata(fs::path(folder) / "metadata.yaml");
  std::vector<std::string> files;
  bool in_list = false;
  for (std::string line; std::getline(metadata, line);) {
    std::string_view text = io::trim(line);
    if (!in_list || !text.starts_with('-')) {
      in_list = text.starts_with("relative_file_paths:");
      continue;
    }
    text = io::trim(text.substr(1));
    if (text.size() > 1 && (text.front() == '"' || text.front() == '\'')) {
      text = text.substr(1, text.size() - 2);
    }
    files.push_back((fs::path(folder) / fs::path(text).filename()).string());
  }
  const auto is_mcap = [](const std::string& file) { return file.ends_with(".mcap"); };
  return std::ranges::all_of(files, is_mcap) ? files : std::vector<std::string>();
}

// The files in a folder that end so, by name.
std::vector<std::string> files_with(const std::string& folder, std::string_view ending) {
  std::vector<std::string> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().string().ends_with(ending)) found.push_back(entry.path().string());
  }
  std::ranges::sort(found);
  return found;
}

// Do a topic's images hold depths? Grey ones of 16 bits may: nothing in them states it.
enum class Depths { none, maybe, certain };

const std::string& encoding_of(const message::Image& image) {
  return image.encoding;
}

const std::string& encoding_of(const CompressedImage& image) {
  return image.format;
}

template <class T>
Depths depths_in(bag::View data) {
  T image;
  decode(data, image);
  const std::string& encoding = encoding_of(image);
  if (encoding.starts_with("16UC1") || encoding.starts_with("32FC1")) return Depths::certain;
  DepthFrame frame;
  read_depth(image, frame);
  return Depths::maybe;
}

// What the first message contains, or none if it cannot be read.
Depths depths_of(SplitBag& reader, const std::string& topic) {
  reader.choose([&](const Channel& channel) {
    return channel.topic == topic &&
           (holds<message::Image>(channel) || holds<CompressedImage>(channel));
  });
  try {
    bag::Message found;
    if (!reader.next(found)) return Depths::none;
    return holds<message::Image>(reader.channel_of(found)) ? depths_in<message::Image>(found.data)
                                                           : depths_in<CompressedImage>(found.data);
  } catch (const Error&) {
    return Depths::none;
  }
}

// Topics of depth images, whose first message states that they are, of those that may be, of
// clouds, and of clouds in types that are not read.
struct Fitting {
  std::vector<std::string> images;
  std::vector<std::string> grey;
  std::vector<std::string> clouds;
  std::vector<std::string> others;
};

// Does the name of a type speak of points? "livox_ros_driver2/msg/CustomMsg",
// "foxglove.PointCloud", "point_cloud_interfaces/msg/CompressedPointCloud2"
bool is_other_cloud(const Channel& channel) {
  const std::string& type = channel.schema.name;
  return !holds<PointCloud2>(channel) &&
         (type.find("PointCloud") != std::string::npos || type.ends_with("/CustomMsg"));
}

Fitting fitting_topics(SplitBag& reader) {
  Fitting fitting;
  const auto add = [](std::vector<std::string>& topics, const std::string& topic) {
    if (std::ranges::count(topics, topic) == 0) topics.push_back(topic);
  };
  for (const Channel& channel : reader.channels()) {
    if (holds<PointCloud2>(channel)) add(fitting.clouds, channel.topic);
    if (is_other_cloud(channel)) {
      add(fitting.others,
          fmt::format("{} ({}, {})", channel.topic, channel.schema.name, channel.message_encoding));
    }
    if (!holds<message::Image>(channel) && !holds<CompressedImage>(channel)) continue;
    const Depths depths = depths_of(reader, channel.topic);
    if (depths == Depths::certain) add(fitting.images, channel.topic);
    if (depths == Depths::maybe) add(fitting.grey, channel.topic);
  }
  return fitting;
}

std::string in_words(const Fitting& fitting) {
  std::vector<std::string> all = fitting.images;
  all.insert(all.end(), fitting.clouds.begin(), fitting.clouds.end());
  for (const std::string& topic : fitting.grey) {
    all.push_back(topic + " (grey of 16 bits, if that is depth)");
  }
  if (!all.empty()) return fmt::format("name one that fits: {}", fmt::join(all, ", "));
  if (!fitting.others.empty()) {
    return fmt::format(
        "of clouds it reads sensor_msgs PointCloud2 in ROS 2's encoding alone, and {} "
        "{} not; record that, or convert it",
        fmt::join(fitting.others, ", "), fitting.others.size() > 1 ? "are" : "is");
  }
  return "it has neither depth images (sensor_msgs Image or CompressedImage, 16UC1 or 32FC1) nor "
         "clouds (PointCloud2) in ROS 2's encoding; 'palpate bag info' lists what it has";
}

}  // namespace

std::string bag_file(const std::string& name) {
  if (is_there(name)) return name;
  const std::size_t topic = name.rfind(":/");
  return name.substr(0, topic != std::string::npos ? topic : find_options(name));
}

std::vector<std::string> recorded_files(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return {path};
  std::vector<std::string> found = listed_files(path);
  if (!found.empty()) return found;
  found = files_with(path, ".mcap");
  if (found.size() == 1) return found;
  if (!found.empty()) {
    throw Error(fmt::format(
        "{}: there are several MCAP files in this folder, and no metadata.yaml that says in which "
        "order they are one recording; name one: {}",
        path, fmt::join(found, ", ")));
  }
  for (const char* other : {".db3", ".mcap.zstd", ".bag"}) {
    found = files_with(path, other);
    if (!found.empty()) return found;  // whose reader reports what they are
  }
  throw Error(path + ": there is no MCAP file in this folder; name one that ROS 2 recorded into");
}

BagName parse_bag_name(const std::string& name) {
  BagName parsed;
  parsed.file = bag_file(name);
  std::string_view rest = std::string_view(name).substr(parsed.file.size());
  if (rest.starts_with(':')) {
    parsed.topic = rest.substr(1, rest.find(',') - 1);
    rest.remove_prefix(1 + parsed.topic.size());
  }
  parsed.options =
      parse_topic_options(rest, fmt::format("bag:{}", name.substr(0, name.size() - rest.size())));
  parsed.files = recorded_files(parsed.file);
  return parsed;
}

std::string topic_of(SplitBag& reader, const BagName& name) {
  const auto is_named = [&](const Channel& channel) {
    return channel.topic == name.topic && may_be_felt(channel);
  };
  if (std::ranges::any_of(reader.channels(), is_named)) return name.topic;
  const Fitting fitting = fitting_topics(reader);
  if (!name.topic.empty()) {
    throw Error(fmt::format("{}: no images and no clouds on {}; {}", name.file, name.topic,
                            in_words(fitting)));
  }
  if (fitting.images.size() == 1) return fitting.images.front();
  if (fitting.images.empty() && fitting.clouds.size() == 1) return fitting.clouds.front();
  throw Error(fmt::format(
      "{}: {}{}", name.file,
      fitting.images.size() + fitting.clouds.size() > 1 ? "several topics could be felt; " : "",
      in_words(fitting)));
}

}  // namespace palpate::sensor
