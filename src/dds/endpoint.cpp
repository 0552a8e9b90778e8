// Readers and writers of a topic's bytes: they take, wait for and count messages.
#include "dds/endpoint.hpp"

#include <dds/dds.h>
#include <fmt/format.h>

#include "dds/payload.hpp"
#include "palpate/base/error.hpp"

namespace palpate::dds {
namespace {

// A writer that waits for slow readers does not wait longer.
constexpr dds_duration_t kLongestWrite = DDS_MSECS(100);

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos qos_of(const Quality& quality, const TopicType& topic) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(),
                       quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kLongestWrite);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  dds_qset_durability(qos.get(),
                      quality.stays ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  if (quality.stays) {
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, quality.depth, -1, -1, -1);
  }
  dds_qset_writer_data_lifecycle(qos.get(), false);
  const dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain);
  const std::string hash = fmt::format("typehash=RIHS01_{};", topic.hash);
  dds_qset_userdata(qos.get(), hash.data(), hash.size());
  return qos;
}

// "rt/camera/depth" of "/camera/depth", as ROS 2 names topics on DDS.
std::string dds_topic(const std::string& topic) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '/';
  };
  if (topic.size() < 2 || topic.front() != '/' || topic.back() == '/' ||
      topic.find("//") != std::string::npos || !std::ranges::all_of(topic, fits)) {
    throw Error(fmt::format("'{}' is not the name of a topic, such as /camera/depth/image_rect_raw",
                            topic));
  }
  return "rt" + topic;
}

Error failure(const TopicType& topic, std::int32_t code) {
  return Error(fmt::format("DDS: topic {} of type {} cannot be had ({})", topic.topic, topic.type,
                           dds_strretcode(-code)));
}

// `type`: what DDS made of the type, which lives as long as the topic.
dds_entity_t make_topic(const Participant& participant, const TopicType& topic,
                        ddsi_sertype*& type) {
  const std::string name = dds_topic(topic.topic);
  type = make_type(message::dds_name(topic.type));
  const dds_entity_t made = dds_create_topic_sertype(participant.entity(), name.c_str(), &type,
                                                     nullptr, nullptr, nullptr);
  if (made < 0) {
    ddsi_sertype_unref(type);
    throw failure(topic, made);
  }
  return made;
}

}  // namespace

RawReader::RawReader(const Participant& participant, const TopicType& topic, const Quality& quality)
    : topic_(topic.topic) {
  ddsi_sertype* type = nullptr;
  const dds_entity_t made = make_topic(participant, topic, type);
  reader_ = dds_create_reader(participant.entity(), made, qos_of(quality, topic).get(), nullptr);
  dds_delete(made);  // the reader holds it
  if (reader_ < 0) throw failure(topic, reader_);
  waits_ = dds_create_waitset(participant.entity());
  // A read condition triggers while a message waits; the reader's status triggers only for new
  // ones.
  dds_waitset_attach(waits_, dds_create_readcondition(reader_, DDS_ANY_STATE), 0);
}

RawReader::~RawReader() {
  dds_delete(waits_);
  dds_delete(reader_);
}

bool RawReader::take(const std::function<void(std::span<const std::uint8_t>)>& use) {
  ddsi_serdata* value = nullptr;
  dds_sample_info_t info;
  while (dds_takecdr(reader_, &value, 1, &info, DDS_ANY_STATE) == 1) {
    const std::unique_ptr<ddsi_serdata, void (*)(ddsi_serdata*)> held(
        value, [](ddsi_serdata* last) { ddsi_serdata_unref(last); });
    if (!info.valid_data) continue;  // a writer has gone
    count(info.publication_handle, number_of(value));
    use(bytes_of(value));
    return true;
  }
  return false;
}

bool RawReader::wait(double timeout) const {
  dds_attach_t ready = 0;
  return dds_waitset_wait(waits_, &ready, 1, static_cast<dds_duration_t>(timeout * 1e9)) > 0;
}

std::size_t RawReader::writers() const {
  dds_subscription_matched_status_t matched{};
  dds_get_subscription_matched_status(reader_, &matched);
  return matched.current_count;
}

void RawReader::count(std::uint64_t writer, std::uint64_t number) {
  if (writer == writer_ && number > number_) lost_ += number - number_ - 1;
  writer_ = writer;
  number_ = number;
}

RawWriter::RawWriter(const Participant& participant, const TopicType& topic, const Quality& quality)
    : topic_(topic.topic) {
  ddsi_sertype* type = nullptr;
  const dds_entity_t made = make_topic(participant, topic, type);
  writer_ = dds_create_writer(participant.entity(), made, qos_of(quality, topic).get(), nullptr);
  dds_delete(made);
  if (writer_ < 0) throw failure(topic, writer_);
  type_ = type;
}

RawWriter::~RawWriter() {
  dds_delete(writer_);
}

bool RawWriter::write(std::span<const std::uint8_t> bytes) {
  return dds_writecdr(writer_, make_payload(static_cast<ddsi_sertype*>(type_), bytes)) == 0;
}

std::size_t RawWriter::readers() const {
  dds_publication_matched_status_t matched{};
  dds_get_publication_matched_status(writer_, &matched);
  return matched.current_count;
}

}  // namespace palpate::dds
