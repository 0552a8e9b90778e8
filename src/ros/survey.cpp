// Lists the ROS topics that palpate can use.
#include "palpate/ros/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "dds/discovery.hpp"
#include "dds/endpoint.hpp"
#include "message/display_types.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using namespace message;

constexpr double kDiscovery = 1;  // s in which running programs find one another (judgement)

// A type that palpate takes or gives, and how a topic of it is used.
struct TopicType {
  std::string_view type;
  std::string_view hash;
  const char* read;   // of one that somebody writes; {} is its name
  const char* write;  // of one that somebody reads
};
constexpr const char* kCamera = "palpate touch ros:{}";
constexpr const char* kHand = "--device ros:generic,pose={},wrench=TOPIC";
constexpr const char* kForce = "--device ros:generic,pose=TOPIC,wrench={}";
constexpr const char* kRobot = "--robot generic,topic={}";

constexpr std::array<TopicType, 6> kTypes = {
    {{Image::kName, Image::kHash, kCamera, nullptr},
     {CompressedImage::kName, CompressedImage::kHash, kCamera, nullptr},
     {PointCloud2::kName, PointCloud2::kHash, kCamera, nullptr},
     {PoseStamped::kName, PoseStamped::kHash, kHand, kRobot},
     {WrenchStamped::kName, WrenchStamped::kHash, nullptr, kForce},
     {TFMessage::kName, TFMessage::kHash, nullptr, nullptr}}};

const TopicType* find_type(const std::string& type) {
  const auto* const found = std::ranges::find(kTypes, type, &TopicType::type);
  return found == kTypes.end() ? nullptr : found;
}

// Command or option that uses such a topic; null: none, as for palpate's own topics.
const char* use_of(const dds::Endpoint& there, const TopicType& type) {
  if (there.topic.starts_with("/palpate/")) return nullptr;
  if (there.writes && there.topic.ends_with("/ee_pose")) return "--device ros:fd,ns=NAMESPACE";
  return there.writes ? type.read : type.write;
}

void add(std::vector<RosTopic>& topics, const dds::Endpoint& there) {
  auto topic = std::ranges::find_if(topics, [&](const RosTopic& each) {
    return each.name == there.topic && each.type == there.type;
  });
  if (topic == topics.end()) {
    topic = topics.insert(topics.end(), RosTopic{});
    topic->name = there.topic;
    topic->type = there.type;
    topic->reliable = true;
  }
  if (there.writes || topic->writers == 0)  // writers come first
    topic->reliable = topic->reliable && there.reliable;
  (there.writes ? topic->writers : topic->readers) += 1;
  const TopicType* type = find_type(there.type);
  if (type == nullptr) return;
  if (!there.hash.empty() && there.hash != fmt::format("RIHS01_{}", type->hash)) {
    topic->mismatch =
        fmt::format("its {} is another version of the type than palpate's", there.type);
  }
  const char* use = use_of(there, *type);
  if (use != nullptr && (there.writes || topic->use.empty()))
    topic->use = fmt::format(fmt::runtime(use), there.topic);
}

// Listens to one topic.
struct Ear {
  Ear(const dds::Participant& participant, RosTopic& its_topic)
      : topic(its_topic),
        reader(participant,
               {topic.name, find_type(topic.type)->type.data(), find_type(topic.type)->hash.data()},
               {}) {}

  void take(double now) {
    while (reader.take([&](std::span<const std::uint8_t> bytes) { frame_in(bytes); })) {
      if (count++ == 0) first = now;
      last = now;
    }
  }

  // All of these types but /tf's begin with a header.
  void frame_in(std::span<const std::uint8_t> bytes) {
    if (!topic.frame.empty() || topic.type == TFMessage::kName) return;
    Header header;
    decode(bytes, header);
    topic.frame = header.frame_id;
  }

  RosTopic& topic;
  dds::RawReader reader;
  std::size_t count = 0;
  double first = 0;
  double last = 0;
};

void listen(const dds::Participant& participant, std::vector<RosTopic>& topics, double seconds) {
  std::vector<std::unique_ptr<Ear>> ears;
  for (RosTopic& topic : topics) {
    if (topic.writers == 0 || find_type(topic.type) == nullptr) continue;
    try {
      ears.push_back(std::make_unique<Ear>(participant, topic));
    } catch (const Error& error) {  // not a name that ROS 2 would give
      topic.mismatch = error.what();
      topic.use.clear();
    }
  }
  SteadyClock clock;
  for (const double end = clock.now() + seconds; clock.now() < end;) {
    clock.wait_until(clock.now() + 1e-3);
    for (const auto& ear : ears) {
      try {
        ear->take(clock.now());
      } catch (const Error& error) {
        ear->topic.mismatch = error.what();
      }
    }
  }
  for (const auto& ear : ears) {
    if (ear->count > 1)
      ear->topic.rate = static_cast<double>(ear->count - 1) / (ear->last - ear->first);
  }
}

}  // namespace

std::vector<RosTopic> survey_ros(double seconds) {
  const dds::Participant participant(dds::environment_options());
  SteadyClock clock;
  clock.wait_until(clock.now() + std::min(kDiscovery, seconds / 2));
  std::vector<RosTopic> topics;
  for (const dds::Endpoint& there : dds::endpoints(participant)) add(topics, there);
  listen(participant, topics, std::max(seconds - kDiscovery, seconds / 2));
  return topics;
}

}  // namespace palpate
