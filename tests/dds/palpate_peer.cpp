// palpate's end of the topics whose other end is fast_peer's: the same arguments and lines.
#include <memory>

#include "dds/endpoint.hpp"
#include "dds/peer.hpp"

int main(int count, char** arguments) {
  using namespace palpate;
  const peer::Task task = peer::task_of(count, arguments);
  const dds::Participant participant(dds::environment_options());
  const dds::Quality quality{.reliable = task.reliable};
  std::vector<std::string> types;
  for (const peer::Line& line : task.lines) types.push_back(line.type());
  std::vector<std::unique_ptr<dds::RawWriter>> writers;
  std::vector<std::unique_ptr<dds::RawReader>> readers;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const dds::TopicType topic{task.lines[i].topic(), types[i].c_str(), task.lines[i].hash.c_str()};
    if (task.writes) {
      writers.push_back(std::make_unique<dds::RawWriter>(participant, topic, quality));
    } else {
      readers.push_back(std::make_unique<dds::RawReader>(participant, topic, quality));
    }
  }
  return peer::run(
      task, [&](std::size_t i, const peer::Bytes& bytes) { writers[i]->write(bytes); },
      [&](std::size_t i, peer::Bytes& bytes) {
        return readers[i]->take(
            [&](auto received) { bytes.assign(received.begin(), received.end()); });
      });
}
