#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "message/cdr.hpp"
#include "support/folder.hpp"

namespace palpate::test {

/// Changes an attachment of that name, or a message of that topic.
using BagChange = std::function<void(const std::string& name, bag::Bytes& data)>;

/// An MCAP file with what `change` makes of its attachments and messages; all of its checksums are
/// right.
inline std::string rewritten(const std::string& file, const BagChange& change) {
  const Folder folder;
  folder.write("run.mcap", file);
  bag::McapReader reader(folder / "run.mcap");
  bag::McapWriter writer(folder / "changed.mcap");
  for (std::size_t i = 0; i < reader.contents().attachments.size(); ++i) {
    bag::Attachment attachment = reader.attachment(i);
    change(attachment.name, attachment.data);
    writer.attach(attachment);
  }
  std::map<std::uint16_t, std::uint16_t> numbers;
  for (const auto& [number, channel] : reader.contents().channels) {
    numbers[number] = writer.add_channel(channel);
  }
  for (bag::Message message; reader.next(message);) {
    bag::Bytes data(message.data.begin(), message.data.end());
    change(reader.channel_of(message).topic, data);
    writer.write(numbers[message.channel], message.stamp, data);
  }
  writer.close();
  return folder.read("changed.mcap");
}

/// The same of one message alone, decoded: number `which`, from 0, of those whose topic ends in
/// `topic`; all of them where it is negative.
template <class Message>
std::string rewritten(const std::string& file, const std::string& topic, int which,
                      const std::function<void(Message&)>& change) {
  int number = 0;
  return rewritten(file, [&](const std::string& name, bag::Bytes& data) {
    if (!name.ends_with(topic)) return;
    const int each = number++;
    if (which >= 0 && each != which) return;
    Message message;
    message::decode(bag::View(data), message);
    change(message);
    data.clear();
    message::encode(message, data);
  });
}

}  // namespace palpate::test
