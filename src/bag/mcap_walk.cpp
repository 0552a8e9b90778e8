// Finds the chunks, channels and schemas of an MCAP file, also of a damaged one.
#include "bag/mcap_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bag/chunk.hpp"
#include "bag/other_file.hpp"

namespace palpate::bag {

namespace {

constexpr std::uint64_t kLargestNote = 16 << 20;  // bytes of a schema, a channel ... (judgement)
constexpr std::uint64_t kAllNotes = 256 << 20;    // bytes of all of them (judgement)
constexpr std::uint64_t kLargestRun = 1 << 20;    // bytes outside chunks read at once (judgement)
constexpr std::uint64_t kAttachmentHead = 64 << 10;  // bytes, mostly names (judgement)
constexpr std::size_t kMostLosses = 20;              // losses listed (judgement)

class Walk {
 public:
  explicit Walk(const RandomFile& file) : file_(file) {}
  Contents run();

 private:
  void read_summary();
  void take_summary(View summary);
  void take_chunk_index(Fields fields);
  void take_statistics(Fields fields);
  void sort_indexed();
  void search(std::uint64_t begin, std::uint64_t end);
  void take(Op op, std::uint64_t at, std::uint64_t length);
  void take_chunk(std::uint64_t at, std::uint64_t length);
  void take_message(std::uint64_t at, std::uint64_t length);
  void take_attachment(std::uint64_t at, std::uint64_t length);
  void count(const Message& message, ChunkSpan& span);

  struct Indexed {
    ChunkSpan span;
    std::uint64_t behind = 0;  // the chunk and its index
  };

  const RandomFile& file_;
  std::uint64_t notes_ = 0;  // bytes of those that were kept
  Contents contents_;
  std::vector<Indexed> indexed_;
  std::uint64_t data_end_ = 0;
  bool counted_ = false;  // the file's end stored how many messages there are
};

Contents Walk::run() {
  const Bytes magic = file_.read(0, std::min<std::uint64_t>(file_.size(), kMagic.size()));
  if (!std::ranges::equal(magic, kMagic)) refuse_other(file_);
  read_summary();
  std::uint64_t at = kMagic.size();
  for (Indexed& indexed : indexed_) {
    search(at, indexed.span.offset);
    contents_.chunks.push_back(std::move(indexed.span));
    at = indexed.behind;
  }
  search(at, data_end_);
  if (!contents_.closed) {
    contents_.lose(fmt::format("the file was not closed; its {} bytes were searched for messages",
                               file_.size()));
  }
  return std::move(contents_);
}

// Uses what the file's end stores, if all of it is there.
void Walk::read_summary() {
  data_end_ = file_.size();
  if (file_.size() < kFileEnd + kMagic.size()) return;
  const std::uint64_t footer_at = file_.size() - kFileEnd;
  const Bytes end = file_.read(footer_at, kFileEnd);
  Fields fields(end);
  const bool is_footer = fields.number<std::uint8_t>() == static_cast<std::uint8_t>(Op::footer) &&
                         fields.number<std::uint64_t>() == kFooter - kRecordHead;
  const auto start = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();
  const auto crc = fields.number<std::uint32_t>();
  if (!is_footer || !std::ranges::equal(fields.left(), kMagic)) return;
  contents_.closed = true;
  data_end_ = footer_at;
  if (start == 0) return;  // it has none
  try {
    if (start < kMagic.size() || start > footer_at) throw Error("it begins outside of the file");
    const Bytes summary = file_.read(start, file_.size() - start);
    const std::size_t checked = summary.size() - kMagic.size() - sizeof(crc);
    if (crc != 0 && crc_of(View(summary).first(checked)) != crc) throw Error("its CRC differs");
    data_end_ = start;
    take_summary(View(summary).first(footer_at - start));
  } catch (const Error& error) {
    contents_ = {};
    contents_.closed = true;
    contents_.lose(fmt::format("the summary at byte {} is damaged: {}", start, error.what()));
    data_end_ = footer_at;
    indexed_.clear();
  }
}

void Walk::take_summary(View summary) {
  std::optional<Fields> statistics;
  each_record(summary, [&](Op op, View content, std::size_t) {
    if (op == Op::schema) contents_.describe(op, content);
  });
  each_record(summary, [&](Op op, View content, std::size_t) {
    if (op == Op::channel) contents_.describe(op, content);
    if (op == Op::chunk_index) take_chunk_index(Fields(content));
    if (op == Op::statistics) statistics = Fields(content);
  });
  if (statistics) take_statistics(*statistics);
  // Without statistics the summary is not trusted: scan the whole file.
  if (!counted_) indexed_.clear();
  sort_indexed();
}

void Walk::take_chunk_index(Fields fields) {
  Indexed indexed;
  ChunkSpan& span = indexed.span;
  span.start = fields.number<std::uint64_t>();
  span.end = fields.number<std::uint64_t>();
  span.offset = fields.number<std::uint64_t>();
  span.length = fields.number<std::uint64_t>();
  Fields offsets(fields.bytes(fields.number<std::uint32_t>()));
  while (!offsets.left().empty()) {
    span.channels.push_back(offsets.number<std::uint16_t>());
    offsets.number<std::uint64_t>();
  }
  const auto indexes = fields.number<std::uint64_t>();
  const std::uint64_t size = file_.size();
  if (span.offset > size || span.length > size || indexes > size) return;  // not to be believed
  indexed.behind = span.offset + span.length + indexes;
  indexed_.push_back(std::move(indexed));
}

void Walk::take_statistics(Fields fields) {
  const auto messages = fields.number<std::uint64_t>();
  fields.number<std::uint16_t>();
  const auto channels = fields.number<std::uint32_t>();
  fields.bytes(3 * sizeof(std::uint32_t));
  const auto start = fields.number<std::uint64_t>();
  const auto end = fields.number<std::uint64_t>();
  Fields counts(fields.bytes(fields.number<std::uint32_t>()));
  if (channels > contents_.channels.size() || (indexed_.empty() && messages > 0)) return;
  while (!counts.left().empty()) {
    const auto found = contents_.channels.find(counts.number<std::uint16_t>());
    const auto number = counts.number<std::uint64_t>();
    if (found != contents_.channels.end()) found->second.count = number;
  }
  counted_ = true;
  contents_.messages = messages;
  if (messages > 0) contents_.start = start;
  contents_.end = end;
}

// Keeps indexed chunks that do not overlap in the data; overlapping ones are searched for instead.
void Walk::sort_indexed() {
  std::ranges::stable_sort(indexed_, {},
                           [](const Indexed& indexed) { return indexed.span.offset; });
  std::uint64_t at = kMagic.size();
  const auto wrong = [&](const Indexed& indexed) {
    if (indexed.span.offset < at || indexed.span.length < kRecordHead ||
        indexed.behind > data_end_) {
      contents_.lose(fmt::format("the index of a chunk at byte {} is wrong", indexed.span.offset));
      return true;
    }
    at = indexed.behind;
    return false;
  };
  std::erase_if(indexed_, wrong);
}

void Walk::search(std::uint64_t begin, std::uint64_t end) {
  while (begin < end) {
    std::uint64_t length = end - begin;  // until it is known
    try {
      const Bytes head = file_.read(begin, std::min<std::uint64_t>(kRecordHead, length));
      Fields fields(head);
      const auto op = static_cast<Op>(fields.number<std::uint8_t>());
      const auto content = fields.number<std::uint64_t>();
      if (content > length - kRecordHead || op == Op{0}) throw Error("a record is cut or damaged");
      if (op == Op::data_end || op == Op::footer) return;
      length = kRecordHead + content;
      take(op, begin + kRecordHead, content);
    } catch (const Error& error) {
      contents_.lose(
          fmt::format("bytes {} to {} are lost: {}", begin, begin + length - 1, error.what()));
    }
    begin += length;
  }
}

void Walk::take(Op op, std::uint64_t at, std::uint64_t length) {
  if (op == Op::chunk) return take_chunk(at, length);
  if (op == Op::message) return take_message(at, length);
  if (op == Op::attachment) return take_attachment(at, length);
  const bool wanted =
      op == Op::header || op == Op::schema || op == Op::channel || op == Op::metadata;
  if (!wanted) return;
  if (length > kLargestNote || (notes_ += length) > kAllNotes)
    throw Error("a record is longer than any honest one");
  const Bytes content = file_.read(at, length);
  Fields fields(content);
  if (op == Op::header) {
    contents_.profile = fields.text();
    contents_.library = fields.text();
  } else if (op == Op::metadata) {
    std::string name = fields.text();
    contents_.metadata.push_back({std::move(name), fields.words()});
  } else {
    contents_.describe(op, content);
  }
}

void Walk::take_chunk(std::uint64_t at, std::uint64_t length) {
  ChunkSpan span{.offset = at - kRecordHead, .length = kRecordHead + length, .channels = {}};
  const Bytes records = unpack(file_.read(at, length));
  each_record(records, [&](Op op, View content, std::size_t) {
    if (op == Op::schema || op == Op::channel) contents_.describe(op, content);
    if (op == Op::message) count(message_of(content), span);
  });
  std::ranges::sort(span.channels);
  span.channels.erase(std::unique(span.channels.begin(), span.channels.end()), span.channels.end());
  if (span.start <= span.end) contents_.chunks.push_back(std::move(span));
}

// Messages without chunk that follow one another become one span.
void Walk::take_message(std::uint64_t at, std::uint64_t length) {
  if (length > kLargestChunk) throw Error("a message is longer than any honest one");
  const Message message = message_of(file_.read(at, std::min<std::uint64_t>(length, kMessageHead)));
  const std::uint64_t offset = at - kRecordHead;
  std::vector<ChunkSpan>& spans = contents_.chunks;
  const bool goes_on = !spans.empty() && spans.back().loose &&
                       spans.back().offset + spans.back().length == offset &&
                       spans.back().length + length < kLargestRun;
  if (!goes_on) spans.push_back({.offset = offset, .channels = {}, .loose = true});
  spans.back().length += kRecordHead + length;
  count(message, spans.back());
}

void Walk::take_attachment(std::uint64_t at, std::uint64_t length) {
  const Bytes content = file_.read(at, std::min(length, kAttachmentHead));
  Fields fields(content);
  AttachmentSpan span{.head = {}, .offset = at, .length = length};
  span.head.log_time = fields.number<std::uint64_t>();
  span.head.create_time = fields.number<std::uint64_t>();
  span.head.name = fields.text();
  span.head.media_type = fields.text();
  span.size = fields.number<std::uint64_t>();
  if (span.size > length) throw Error("an attachment is shorter than it says");
  contents_.attachments.push_back(std::move(span));
}

void Walk::count(const Message& message, ChunkSpan& span) {
  span.start = std::min(span.start, message.stamp.log);
  span.end = std::max(span.end, message.stamp.log);
  std::vector<std::uint16_t>& channels = span.channels;
  if (!span.loose && (channels.empty() || channels.back() != message.channel)) {
    channels.push_back(message.channel);
  }
  const auto channel = contents_.channels.find(message.channel);
  if (counted_ || channel == contents_.channels.end()) return;
  ++channel->second.count;
  ++contents_.messages;
  contents_.start = std::min(contents_.start, message.stamp.log);
  contents_.end = std::max(contents_.end, message.stamp.log);
}

}  // namespace

void Contents::lose(const std::string& what) {
  if (losses.size() > kMostLosses || std::ranges::find(losses, what) != losses.end()) return;
  losses.push_back(losses.size() < kMostLosses ? what : "there are more losses");
}

void Contents::describe(Op op, View content) {
  Fields fields(content);
  const auto number = fields.number<std::uint16_t>();
  if (op == Op::schema) {
    Schema schema{fields.text(), fields.text(), fields.text()};
    schemas.try_emplace(number, std::move(schema));
    return;
  }
  const auto schema = schemas.find(fields.number<std::uint16_t>());
  Channel channel;
  channel.topic = fields.text();
  channel.message_encoding = fields.text();
  channel.metadata = fields.words();
  if (schema != schemas.end()) channel.schema = schema->second;
  channels.try_emplace(number, std::move(channel));
}

Contents walk(const RandomFile& file) {
  return Walk(file).run();
}

}  // namespace palpate::bag
