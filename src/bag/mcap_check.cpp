// Compares an MCAP file with its own checksums, indexes and counts.
#include "bag/mcap_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "bag/chunk.hpp"
#include "bag/mcap_facts.hpp"

namespace palpate::bag {

namespace {

constexpr std::uint64_t kPiece = 1 << 20;  // bytes that are read at once (judgement)

std::uint32_t crc_in(const RandomFile& file, std::uint64_t begin, std::uint64_t end) {
  uLong crc = 0;
  while (begin < end) {
    const Bytes piece = file.read(begin, std::min(kPiece, end - begin));
    crc = crc32_z(crc, piece.data(), piece.size());
    begin += piece.size();
  }
  return static_cast<std::uint32_t>(crc);
}

// Walks through the data section of a file, which has to follow the format.
class DataCheck {
 public:
  DataCheck(const RandomFile& file, Contents& contents) : file_(file), contents_(contents) {}
  void run();

 private:
  using Entries = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // times, offsets

  void take(Op op, std::uint64_t at, std::uint64_t length);
  void take_chunk(std::uint64_t at, View content);
  void take_records(View records, ChunkFacts& chunk);
  void take_index(std::uint64_t at, View content);
  void take_attachment(std::uint64_t at, std::uint64_t length);
  void take_metadata(std::uint64_t at, View content);
  void take_description(Op op, View content);
  void take_message(View content);
  void end_chunk();
  void end_data(std::uint64_t at, View content);
  void end_file(std::uint64_t at);

  const RandomFile& file_;
  Contents& contents_;
  DataFacts data_;
  // The chunk before, while only its message indexes follow, and its messages without one.
  std::map<std::uint64_t, ChunkFacts>::iterator chunk_ = data_.chunks.end();
  std::map<std::uint16_t, Entries> unindexed_;
};

void DataCheck::run() {
  std::uint64_t at = kMagic.size();
  for (Op op{}; op != Op::data_end;) {
    const Bytes head = file_.read(at, kRecordHead);
    Fields fields(head);
    op = static_cast<Op>(fields.number<std::uint8_t>());
    const auto length = fields.number<std::uint64_t>();
    if ((op == Op::header) != (at == kMagic.size()) || length > file_.size() - at - kRecordHead) {
      throw Error(fmt::format("byte {}: a record of kind {} and {} bytes has no place there", at,
                              static_cast<int>(op), length));
    }
    take(op, at, length);
    at += kRecordHead + length;
  }
  end_file(at);
}

void DataCheck::take(Op op, std::uint64_t at, std::uint64_t length) {
  if (op != Op::message_index) end_chunk();
  if (op == Op::attachment) return take_attachment(at, length);
  if (static_cast<std::uint8_t>(op) >= kPrivate) return;
  const std::uint64_t used =
      op == Op::message ? std::min<std::uint64_t>(length, kMessageHead) : length;
  const Bytes content = file_.read(at + kRecordHead, used);
  if (op == Op::header) {
    Fields fields(content);
    fields.text();
    fields.text();
  } else if (op == Op::schema || op == Op::channel) {
    take_description(op, content);
  } else if (op == Op::message) {
    take_message(content);
  } else if (op == Op::chunk) {
    take_chunk(at, content);
  } else if (op == Op::message_index) {
    take_index(at, content);
  } else if (op == Op::metadata) {
    take_metadata(at, content);
  } else if (op == Op::data_end) {
    end_data(at, content);
  } else {
    throw Error(
        fmt::format("byte {}: a record of kind {} has no place there", at, static_cast<int>(op)));
  }
}

void DataCheck::take_chunk(std::uint64_t at, View content) {
  chunk_ = data_.chunks.try_emplace(at).first;
  ChunkFacts& chunk = chunk_->second;
  Fields fields(content);
  chunk.start = fields.number<std::uint64_t>();
  chunk.end = fields.number<std::uint64_t>();
  chunk.length = kRecordHead + content.size();
  chunk.size = fields.number<std::uint64_t>();
  fields.number<std::uint32_t>();  // unpack() checks its CRC
  chunk.compression = fields.text();
  chunk.packed = fields.number<std::uint64_t>();
  try {
    take_records(unpack(content), chunk);
  } catch (const Error& error) {
    chunk.lost = true;
    data_.whole = false;
    lose_first(contents_, fmt::format("the chunk at byte {} is lost: {}", at, error.what()));
  }
}

void DataCheck::take_records(View records, ChunkFacts& chunk) {
  std::uint64_t start = UINT64_MAX;
  std::uint64_t end = 0;
  each_record(records, [&](Op op, View content, std::size_t offset) {
    if (op == Op::schema || op == Op::channel) return take_description(op, content);
    if (static_cast<std::uint8_t>(op) >= kPrivate) return;
    if (op != Op::message) throw Error("a record in it has no place there");
    take_message(content);
    const Message message = message_of(content);
    start = std::min(start, message.stamp.log);
    end = std::max(end, message.stamp.log);
    unindexed_[message.channel].emplace_back(message.stamp.log, offset);
  });
  if (unindexed_.empty()) return;
  const std::string where = fmt::format("the chunk at byte {}", chunk_->first);
  compare(contents_, where, "that its first message is of time", chunk.start, start);
  compare(contents_, where, "that its last message is of time", chunk.end, end);
}

void DataCheck::take_index(std::uint64_t at, View content) {
  if (chunk_ == data_.chunks.end()) {
    throw Error(fmt::format("byte {}: a message index belongs to no chunk", at));
  }
  Fields fields(content);
  const auto channel = fields.number<std::uint16_t>();
  Entries stored;
  for (Fields list(fields.bytes(fields.number<std::uint32_t>())); !list.left().empty();) {
    const auto time = list.number<std::uint64_t>();
    stored.emplace_back(time, list.number<std::uint64_t>());
  }
  chunk_->second.indexes += kRecordHead + content.size();
  chunk_->second.offsets[channel] = at;
  if (chunk_->second.lost) return;
  Entries found = std::move(unindexed_[channel]);
  unindexed_.erase(channel);
  std::ranges::sort(stored);
  std::ranges::sort(found);
  if (stored == found) return;
  contents_.lose(
      fmt::format("the message index at byte {} does not lead to the {} messages of "
                  "channel {} in its chunk",
                  at, found.size(), channel));
}

// A chunk has no message indexes at all, or one of each channel in it.
void DataCheck::end_chunk() {
  if (chunk_ != data_.chunks.end() && !chunk_->second.offsets.empty() && !chunk_->second.lost) {
    for (const auto& [channel, entries] : unindexed_) {
      contents_.lose(
          fmt::format("no index leads to the {} messages of channel {} in the chunk at "
                      "byte {}",
                      entries.size(), channel, chunk_->first));
    }
  }
  chunk_ = data_.chunks.end();
  unindexed_.clear();
}

void DataCheck::take_message(View content) {
  const Message message = message_of(content);
  if (!data_.descriptions.contains({Op::channel, message.channel})) {
    lose_first(contents_, fmt::format("nothing says what channel {} is before its first message",
                                      message.channel));
  }
  ++data_.messages;
  ++data_.counts[message.channel];
  data_.start = std::min(data_.start, message.stamp.log);
  data_.end = std::max(data_.end, message.stamp.log);
}

void DataCheck::take_description(Op op, View content) {
  const auto number = Fields(content).number<std::uint16_t>();
  const auto [found, is_new] =
      data_.descriptions.try_emplace({op, number}, description_of(op, content));
  if (!is_new && found->second != description_of(op, content)) {
    contents_.lose(fmt::format("{} {} is described in two ways",
                               op == Op::schema ? "schema" : "channel", number));
  }
  if (op == Op::schema) return;
  Fields fields(content);
  fields.number<std::uint16_t>();
  const auto schema = fields.number<std::uint16_t>();
  if (schema != 0 && !data_.descriptions.contains({Op::schema, schema})) {
    contents_.lose(fmt::format("channel {} is of schema {}, which is not there", number, schema));
  }
}

void DataCheck::take_attachment(std::uint64_t at, std::uint64_t length) {
  const std::uint64_t begin = at + kRecordHead;
  const Bytes head = file_.read(begin, std::min(length, kPiece));
  Fields fields(head);
  const auto log = fields.number<std::uint64_t>();
  const auto made = fields.number<std::uint64_t>();
  const std::string name = fields.text();
  const std::string kind = fields.text();
  const auto size = fields.number<std::uint64_t>();
  Record(data_.notes[{Op::attachment_index, at}], Op::attachment_index)
      .numbers(at, kRecordHead + length, log, made, size)
      .text(name)
      .text(kind);
  const std::uint64_t checked = head.size() - fields.left().size() + size;
  if (size > length || checked + sizeof(std::uint32_t) > length) {
    throw Error(fmt::format("byte {}: an attachment is shorter than it says", at));
  }
  const Bytes crc = file_.read(begin + checked, sizeof(std::uint32_t));
  const auto stored = Fields(crc).number<std::uint32_t>();
  if (stored != 0 && stored != crc_in(file_, begin, begin + checked)) {
    contents_.lose(fmt::format("the attachment {} is damaged: its CRC differs", name));
  }
}

void DataCheck::take_metadata(std::uint64_t at, View content) {
  Fields fields(content);
  const std::string name = fields.text();
  fields.words();
  Record(data_.notes[{Op::metadata_index, at}], Op::metadata_index)
      .numbers(at, std::uint64_t{kRecordHead + content.size()})
      .text(name);
}

// The checksum of all data shows nothing more where a part is known to be damaged.
void DataCheck::end_data(std::uint64_t at, View content) {
  const auto stored = Fields(content).number<std::uint32_t>();
  if (stored == 0 || !contents_.losses.empty() || stored == crc_in(file_, 0, at)) return;
  contents_.lose(
      fmt::format("bytes 0 to {} do not have the CRC that the end of the data says; "
                  "something in them changed that no other checksum covers",
                  at - 1));
}

void DataCheck::end_file(std::uint64_t at) {
  const Bytes rest = file_.read(at, file_.size() - at);
  if (rest.size() < kFileEnd) throw Error(fmt::format("byte {}: the file has no end", at));
  const View records = View(rest).first(rest.size() - kFileEnd);
  Fields footer(View(rest).subspan(records.size() + kRecordHead));
  const auto begin = footer.number<std::uint64_t>();
  const auto offsets = footer.number<std::uint64_t>();
  const std::uint64_t checked = rest.size() - footer.left().size();
  const auto crc = footer.number<std::uint32_t>();
  if (crc != 0 && crc != crc_of(View(rest).first(checked)))
    throw Error("the CRC of the summary differs");
  compare(contents_, "the end of the file", "that the summary begins at byte", begin,
          records.empty() ? 0 : at);
  compare_summary({at, records, offsets}, data_, contents_);
}

}  // namespace

void check(const RandomFile& file, Contents& contents) {
  try {
    DataCheck(file, contents).run();
  } catch (const Error& error) {
    lose_first(contents, error.what());
  }
}

}  // namespace palpate::bag
