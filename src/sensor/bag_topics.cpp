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
#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

namespace fs = std::filesystem;
using bag::Channel;
using message::CompressedImage;
using message::PointCloud2;

constexpr std::string_view kFrameOption = ",frame=";

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

// Finds the files of a recording: ROS 2 records a folder, with one file or several.
std::vector<std::string> files_of(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return {path};
  std::vector<std::string> found = listed_files(path);
  if (!found.empty()) return found;
  for (const auto& entry : fs::directory_iterator(path, ignored)) {
    if (entry.path().extension() == ".mcap") found.push_back(entry.path().string());
  }
  std::ranges::sort(found);
  if (found.size() == 1) return found;
  throw Error(found.empty()
                  ? fmt::format("{}: there is no MCAP file in this folder; bags of another format "
                                "become one by 'ros2 bag convert'",
                                path)
                  : fmt::format("{}: there are several MCAP files in this folder, and no "
                                "metadata.yaml that says in which order they are one recording; "
                                "name one: {}",
                                path, fmt::join(found, ", ")));
}

// "" where nobody's message says what it is.
std::string encoding_of(SplitBag& reader, const std::string& topic) {
  reader.choose([&](const Channel& channel) {
    return channel.topic == topic &&
           (holds<message::Image>(channel) || holds<CompressedImage>(channel));
  });
  try {
    bag::Message found;
    if (!reader.next(found)) return {};
    if (holds<message::Image>(reader.channel_of(found))) {
      message::Image image;
      decode(found.data, image);
      return image.encoding;
    }
    CompressedImage image;
    decode(found.data, image);
    return image.format;
  } catch (const Error&) {
    return {};
  }
}

// Topics of depth images, whose first message says that they are, and of clouds.
struct Fitting {
  std::vector<std::string> images;
  std::vector<std::string> clouds;
};

Fitting fitting_topics(SplitBag& reader) {
  Fitting fitting;
  const auto add = [](std::vector<std::string>& topics, const std::string& topic) {
    if (std::ranges::count(topics, topic) == 0) topics.push_back(topic);
  };
  for (const Channel& channel : reader.channels()) {
    if (holds<PointCloud2>(channel)) add(fitting.clouds, channel.topic);
    if (!holds<message::Image>(channel) && !holds<CompressedImage>(channel)) continue;
    const std::string encoding = encoding_of(reader, channel.topic);
    if (encoding.starts_with("16UC1") || encoding.starts_with("32FC1")) {
      add(fitting.images, channel.topic);
    }
  }
  return fitting;
}

std::string in_words(const Fitting& fitting) {
  std::vector<std::string> all = fitting.images;
  all.insert(all.end(), fitting.clouds.begin(), fitting.clouds.end());
  if (!all.empty()) return fmt::format("name one that fits: {}", fmt::join(all, ", "));
  return "it has neither depth images (sensor_msgs Image or CompressedImage, 16UC1 or 32FC1) nor "
         "clouds (PointCloud2) in ROS 2's encoding; 'palpate bag info' lists what it has";
}

}  // namespace

BagName parse_bag_name(const std::string& name) {
  if (is_there(name)) return {name, files_of(name), {}, {}};
  const std::size_t topic = name.rfind(":/");
  const std::size_t option =
      topic == std::string::npos ? name.rfind(kFrameOption) : name.find(kFrameOption, topic);
  BagName parsed;
  parsed.file = name.substr(0, std::min(topic, option));
  if (topic != std::string::npos) parsed.topic = name.substr(topic + 1, option - topic - 1);
  if (option != std::string::npos) {
    parsed.frame = name.substr(option + kFrameOption.size());
    if (parsed.frame.empty()) {
      throw Error(fmt::format("bag:{}: no frame is named; write bag:FILE,frame=FRAME", name));
    }
  }
  parsed.files = files_of(parsed.file);
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
  throw Error(fmt::format("{}: {}", name.file,
                          fitting.images.size() + fitting.clouds.size() == 0
                              ? in_words(fitting)
                              : "several topics could be felt; " + in_words(fitting)));
}

}  // namespace palpate::sensor
