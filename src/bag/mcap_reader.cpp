// Merges the chunks of an MCAP file into one stream of messages in time order.
#include "bag/mcap_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "bag/chunk.hpp"

namespace palpate::bag {

namespace {

constexpr std::uint64_t kMostLoaded = 1 << 30;  // bytes of chunks in memory (judgement)

}  // namespace

McapReader::McapReader(RandomFile file, Contents contents)
    : file_(std::move(file)), contents_(std::move(contents)) {
  order_.resize(contents_.chunks.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::ranges::stable_sort(order_, {}, [&](std::size_t i) { return contents_.chunks[i].start; });
}

void McapReader::choose(const std::function<bool(const Channel&)>& wanted, std::uint64_t from) {
  unwanted_.assign(std::size_t{UINT16_MAX} + 1, false);
  for (const auto& [number, channel] : contents_.channels) unwanted_[number] = !wanted(channel);
  from_ = from;
  upcoming_ = 0;
  loaded_.clear();
}

bool McapReader::wants(std::uint16_t channel) const {
  return unwanted_.empty() || !unwanted_[channel];
}

bool McapReader::next(Message& message) {
  std::erase_if(loaded_, [](const Loaded& chunk) { return chunk.next == chunk.entries.size(); });
  Loaded* chunk = soonest();
  while (upcoming_ < order_.size()) {
    const ChunkSpan& span = contents_.chunks[order_[upcoming_]];
    if (chunk != nullptr && chunk->entries[chunk->next].time < span.start) break;
    ++upcoming_;
    load(span);
    chunk = soonest();
  }
  if (chunk == nullptr) return false;
  const Entry& entry = chunk->entries[chunk->next++];
  message = message_of(View(chunk->records).subspan(entry.begin, entry.size));
  return true;
}

// Chunk with the earliest message; at equal times the one that comes first in the file.
McapReader::Loaded* McapReader::soonest() {
  const auto time = [](const Loaded& chunk) {
    return std::pair(chunk.entries[chunk.next].time, chunk.offset);
  };
  const auto found = std::ranges::min_element(loaded_, {}, time);
  return found == loaded_.end() ? nullptr : &*found;
}

void McapReader::load(const ChunkSpan& span) {
  const auto wanted = [&](std::uint16_t channel) { return wants(channel); };
  if (span.end < from_) return;
  if (!span.channels.empty() && std::ranges::none_of(span.channels, wanted)) return;
  Loaded chunk;
  chunk.offset = span.offset;
  try {
    chunk.records = file_.read(span.offset, span.length);
    if (!span.loose) {
      Fields fields(chunk.records);
      const bool is_chunk = fields.number<std::uint8_t>() == static_cast<std::uint8_t>(Op::chunk) &&
                            fields.number<std::uint64_t>() == span.length - kRecordHead;
      if (!is_chunk) throw Error("there should be a chunk");
      chunk.records = unpack(fields.left());
    }
    each_record(chunk.records, [&](Op op, View content, std::size_t offset) {
      if (op == Op::message) take(chunk, content, offset + kRecordHead);
    });
  } catch (const Error& error) {
    contents_.lose(fmt::format("messages in bytes {} to {} are lost: {}", span.offset,
                               span.offset + span.length - 1, error.what()));
  }
  if (chunk.entries.empty()) return;
  std::ranges::stable_sort(chunk.entries, {}, &Entry::time);
  std::uint64_t held = chunk.records.size();
  for (const Loaded& other : loaded_) held += other.records.size();
  if (held > kMostLoaded) {
    throw Error(
        fmt::format("{}: {} chunks overlap in time and do not fit into memory; sort it "
                    "first ('mcap sort')",
                    file_.path(), loaded_.size() + 1));
  }
  loaded_.push_back(std::move(chunk));
}

void McapReader::take(Loaded& chunk, View content, std::size_t begin) {
  const Message message = message_of(content);
  if (!wants(message.channel) || message.stamp.log < from_) return;
  if (!contents_.channels.contains(message.channel)) {
    contents_.lose(fmt::format("messages of channel {} are lost: nothing says what they are",
                               message.channel));
    return;
  }
  chunk.entries.push_back({message.stamp.log, static_cast<std::uint32_t>(begin),
                           static_cast<std::uint32_t>(content.size())});
}

Attachment McapReader::attachment(std::size_t index) const {
  const AttachmentSpan& span = contents_.attachments.at(index);
  const Bytes content = file_.read(span.offset, span.length);
  Attachment attachment = span.head;
  Fields fields(content);
  fields.bytes(2 * sizeof(std::uint64_t));
  fields.text();
  fields.text();
  const View data = fields.bytes(fields.number<std::uint64_t>());
  const View checked = View(content).first(content.size() - fields.left().size());
  const auto crc = fields.number<std::uint32_t>();
  if (crc != 0 && crc != crc_of(checked)) {
    throw Error(fmt::format("{}: the attachment {} is damaged: its CRC differs", file_.path(),
                            attachment.name));
  }
  attachment.data.assign(data.begin(), data.end());
  return attachment;
}

}  // namespace palpate::bag
