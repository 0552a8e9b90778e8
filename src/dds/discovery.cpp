// Lists the writers and readers of ROS topics that discovery has found.
#include "dds/discovery.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <array>
#include <memory>

namespace palpate::dds {
namespace {

// "sensor_msgs/Image" of "sensor_msgs::msg::dds_::Image_".
std::string ros_type(const std::string& dds_type) {
  constexpr std::string_view kMiddle = "::msg::dds_::";
  const std::size_t middle = dds_type.find(kMiddle);
  if (middle == std::string::npos || !dds_type.ends_with('_')) return dds_type;
  const std::size_t name = middle + kMiddle.size();
  return dds_type.substr(0, middle) + "/" + dds_type.substr(name, dds_type.size() - name - 1);
}

std::string hash_in(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  const std::unique_ptr<void, void (*)(void*)> held(data, dds_free);
  const std::string text(static_cast<const char*>(data), size);
  constexpr std::string_view kKey = "typehash=";
  const std::size_t at = text.find(kKey);
  if (at == std::string::npos) return {};
  return text.substr(at + kKey.size(), text.find(';', at) - at - kKey.size());
}

Endpoint endpoint_of(const dds_builtintopic_endpoint_t& sample, bool writes) {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t blocking = 0;
  dds_qget_reliability(sample.qos, &reliability, &blocking);
  dds_qget_durability(sample.qos, &durability);
  return {.topic = std::string(sample.topic_name).substr(2),
          .type = ros_type(sample.type_name),
          .hash = hash_in(sample.qos),
          .writes = writes,
          .reliable = reliability == DDS_RELIABILITY_RELIABLE,
          .stays = durability >= DDS_DURABILITY_TRANSIENT_LOCAL};
}

void collect(const Participant& participant, bool writes, std::vector<Endpoint>& found) {
  const dds_entity_t reader = dds_create_reader(
      participant.entity(),
      writes ? DDS_BUILTIN_TOPIC_DCPSPUBLICATION : DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr,
      nullptr);
  constexpr std::size_t kAtOnce = 64;
  std::array<void*, kAtOnce> samples{};
  std::array<dds_sample_info_t, kAtOnce> infos{};
  for (std::int32_t count = 1; count > 0;) {
    count = dds_take(reader, samples.data(), infos.data(), kAtOnce, kAtOnce);
    for (std::int32_t i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const auto* sample = static_cast<const dds_builtintopic_endpoint_t*>(samples[k]);
      const bool alive = infos[k].valid_data && infos[k].instance_state == DDS_IST_ALIVE;
      if (alive && std::string_view(sample->topic_name).starts_with("rt/")) {
        found.push_back(endpoint_of(*sample, writes));
      }
    }
    if (count > 0) dds_return_loan(reader, samples.data(), count);
    samples[0] = nullptr;
  }
  dds_delete(reader);
}

}  // namespace

std::vector<Endpoint> endpoints(const Participant& participant) {
  std::vector<Endpoint> found;
  collect(participant, true, found);
  collect(participant, false, found);
  std::ranges::stable_sort(found, {}, &Endpoint::topic);
  return found;
}

}  // namespace palpate::dds
