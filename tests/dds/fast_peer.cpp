// Another vendor's end of a topic, with payloads that nobody looks into: fast_peer write|read
// reliable|best_effort SECONDS. Standard input: lines "NAME HASH HEX" (print_types). write: sends
// each ten times a second. read: prints "NAME HEX" of the first that comes of each, and ends once
// all have come.
#include <chrono>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <thread>

#include "dds/peer.hpp"

namespace {

namespace fast = eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using palpate::peer::Bytes;
using palpate::peer::Line;

class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1 << 20;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    const Bytes& bytes = *static_cast<Bytes*>(data);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

struct Peer {
  fast::DomainParticipant* participant =
      fast::DomainParticipantFactory::get_instance()->create_participant(
          0, fast::PARTICIPANT_QOS_DEFAULT);
  fast::Publisher* publisher = participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
  fast::Subscriber* subscriber = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);

  fast::Topic* topic(const Line& line) const {
    const fast::TypeSupport type(new RawType(line.dds_type()));
    type.register_type(participant);
    return participant->create_topic("rt" + line.topic(), line.dds_type(), fast::TOPIC_QOS_DEFAULT);
  }
};

auto kind_of(bool reliable) {
  return reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
}

}  // namespace

int main(int count, char** arguments) {
  const palpate::peer::Task task = palpate::peer::task_of(count, arguments);
  const Peer peer;
  std::vector<fast::DataWriter*> writers;
  std::vector<fast::DataReader*> readers;
  for (const Line& line : task.lines) {
    if (task.writes) {
      fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
      qos.reliability().kind = kind_of(task.reliable);
      writers.push_back(peer.publisher->create_datawriter(peer.topic(line), qos));
    } else {
      fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
      qos.reliability().kind = kind_of(task.reliable);
      readers.push_back(peer.subscriber->create_datareader(peer.topic(line), qos));
    }
  }
  return palpate::peer::run(
      task,
      [&](std::size_t i, const Bytes& bytes) { writers[i]->write(const_cast<Bytes*>(&bytes)); },
      [&](std::size_t i, Bytes& bytes) {
        fast::SampleInfo info;
        return readers[i]->take_next_sample(&bytes, &info) ==
                   eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK &&
               info.valid_data;
      });
}
