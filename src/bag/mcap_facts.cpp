// Compares the summary of an MCAP file with what its data are.
#include "bag/mcap_facts.hpp"

#include <algorithm>

#include "bag/chunk.hpp"

namespace palpate::bag {

namespace {

class SummaryCheck {
 public:
  SummaryCheck(const DataFacts& data, Contents& contents) : data_(data), contents_(contents) {}
  void run(const SummaryPart& summary);

 private:
  using Span = std::pair<std::uint64_t, std::uint64_t>;  // begin, length

  void take(Op op, View content, Span span);
  void take_chunk_index(Fields fields);
  void take_note_index(Op op, View content);
  void take_statistics(Fields fields);
  void take_offset(Fields fields);
  [[nodiscard]] std::uint64_t data_count(Op op) const;

  const DataFacts& data_;
  Contents& contents_;
  std::map<Op, Span> groups_;
  std::map<Op, std::uint64_t> taken_;  // records
};

void SummaryCheck::run(const SummaryPart& summary) {
  each_record(summary.records, [&](Op op, View content, std::size_t offset) {
    take(op, content, {summary.at + offset, kRecordHead + content.size()});
  });
  const auto offsets = groups_.find(Op::summary_offset);
  if (offsets != groups_.end()) {
    compare(contents_, "the end of the file", "that the summary's offsets begin at byte",
            summary.offsets, offsets->second.first);
  }
  for (const Op op : {Op::chunk_index, Op::attachment_index, Op::metadata_index}) {
    if (taken_[op] == 0) continue;  // it has no such indexes
    const char* what = op == Op::chunk_index        ? "chunks"
                       : op == Op::attachment_index ? "attachments"
                                                    : "metadata records";
    compare(contents_, "the summary", fmt::format("where {} are:", what), taken_[op],
            data_count(op));
  }
}

std::uint64_t SummaryCheck::data_count(Op op) const {
  if (op == Op::chunk_index) return data_.chunks.size();
  return static_cast<std::uint64_t>(
      std::ranges::count_if(data_.notes, [&](const auto& note) { return note.first.first == op; }));
}

void SummaryCheck::take(Op op, View content, Span span) {
  Span& group = groups_.try_emplace(op, span.first, 0).first->second;
  group.second += span.second;
  ++taken_[op];
  if (op == Op::schema || op == Op::channel) {
    const auto number = Fields(content).number<std::uint16_t>();
    const auto found = data_.descriptions.find({op, number});
    if (found != data_.descriptions.end() && found->second != description_of(op, content)) {
      contents_.lose(fmt::format("the summary describes {} {} in another way than the data do",
                                 op == Op::schema ? "schema" : "channel", number));
    }
  } else if (op == Op::chunk_index) {
    take_chunk_index(Fields(content));
  } else if (op == Op::attachment_index || op == Op::metadata_index) {
    take_note_index(op, content);
  } else if (op == Op::statistics) {
    take_statistics(Fields(content));
  } else if (op == Op::summary_offset) {
    take_offset(Fields(content));
  } else if (static_cast<std::uint8_t>(op) < kPrivate) {
    throw Error(fmt::format("byte {}: a record of kind {} has no place there", span.first,
                            static_cast<int>(op)));
  }
}

void SummaryCheck::take_chunk_index(Fields fields) {
  const auto start = fields.number<std::uint64_t>();
  const auto end = fields.number<std::uint64_t>();
  const auto at = fields.number<std::uint64_t>();
  const std::string where = fmt::format("the summary's index of the chunk at byte {}", at);
  const auto found = data_.chunks.find(at);
  if (found == data_.chunks.end()) return contents_.lose(where + ": there is no chunk");
  const ChunkFacts& chunk = found->second;
  compare(contents_, where, "that it begins at time", start, chunk.start);
  compare(contents_, where, "that it ends at time", end, chunk.end);
  compare(contents_, where, "how many bytes it has:", fields.number<std::uint64_t>(), chunk.length);
  std::map<std::uint16_t, std::uint64_t> offsets;
  for (Fields list(fields.bytes(fields.number<std::uint32_t>())); !list.left().empty();) {
    const auto channel = list.number<std::uint16_t>();
    offsets[channel] = list.number<std::uint64_t>();
  }
  // None: the index does not store where they lie.
  if (!offsets.empty() && offsets != chunk.offsets)
    contents_.lose(where + ": its message indexes lie elsewhere");
  compare(contents_, where,
          "how many bytes its message indexes have:", fields.number<std::uint64_t>(),
          chunk.indexes);
  compare(contents_, where, "that its compression is", fields.text(), chunk.compression);
  compare(contents_, where, "how many bytes it is packed in:", fields.number<std::uint64_t>(),
          chunk.packed);
  compare(contents_, where, "how many bytes it becomes:", fields.number<std::uint64_t>(),
          chunk.size);
}

void SummaryCheck::take_note_index(Op op, View content) {
  const auto at = Fields(content).number<std::uint64_t>();
  const std::string what = op == Op::attachment_index ? "attachment" : "metadata record";
  const auto found = data_.notes.find({op, at});
  // The format may be given further fields.
  const bool same =
      found != data_.notes.end() && content.size() + kRecordHead >= found->second.size() &&
      std::equal(found->second.begin() + kRecordHead, found->second.end(), content.begin());
  if (same) return;
  contents_.lose(
      fmt::format("the summary's index of the {} at byte {} is not what is there", what, at));
}

// Channels without messages may stand in the summary alone.
void SummaryCheck::take_statistics(Fields fields) {
  if (!data_.whole) return;
  const auto count = [&](const char* what, std::uint64_t stored, std::uint64_t found) {
    compare(contents_, "the statistics", fmt::format("how many {} there are:", what), stored,
            found);
  };
  const auto described = [&](Op op, std::uint64_t stored) {
    const auto found = static_cast<std::uint64_t>(std::ranges::count_if(
        data_.descriptions, [&](const auto& each) { return each.first.first == op; }));
    return stored == taken_[op] ? stored : found;
  };
  count("messages", fields.number<std::uint64_t>(), data_.messages);
  const std::uint64_t schemas = fields.number<std::uint16_t>();
  count("schemas", schemas, described(Op::schema, schemas));
  const std::uint64_t channels = fields.number<std::uint32_t>();
  count("channels", channels, described(Op::channel, channels));
  count("attachments", fields.number<std::uint32_t>(), data_count(Op::attachment_index));
  count("metadata records", fields.number<std::uint32_t>(), data_count(Op::metadata_index));
  count("chunks", fields.number<std::uint32_t>(), data_.chunks.size());
  const auto start = fields.number<std::uint64_t>();
  const auto end = fields.number<std::uint64_t>();
  if (data_.messages > 0) {
    compare(contents_, "the statistics", "that the first message is of time", start, data_.start);
    compare(contents_, "the statistics", "that the last message is of time", end, data_.end);
  }
  auto counts = data_.counts;
  for (Fields list(fields.bytes(fields.number<std::uint32_t>())); !list.left().empty();) {
    const auto channel = list.number<std::uint16_t>();
    count(fmt::format("messages of channel {}", channel).c_str(), list.number<std::uint64_t>(),
          counts[channel]);
  }
}

void SummaryCheck::take_offset(Fields fields) {
  const auto op = static_cast<Op>(fields.number<std::uint8_t>());
  const auto begin = fields.number<std::uint64_t>();
  const Span stored{begin, fields.number<std::uint64_t>()};
  const auto group = groups_.find(op);
  if (group == groups_.end() && stored.second == 0) return;  // writers name empty groups, too
  if (group != groups_.end() && group->second == stored) return;
  contents_.lose(
      fmt::format("the summary says that its records of kind {} are the {} bytes from "
                  "byte {} on, where they are not",
                  static_cast<int>(op), stored.second, stored.first));
}

}  // namespace

Bytes description_of(Op op, View content) {
  Bytes bytes;
  Fields fields(content);
  const auto number = fields.number<std::uint16_t>();
  if (op == Op::schema) {
    Record record(bytes, op);
    record.numbers(number);
    for (int i = 0; i < 3; ++i) record.text(fields.text());
  } else {
    Record record(bytes, op);
    record.numbers(number, fields.number<std::uint16_t>());
    for (int i = 0; i < 2; ++i) record.text(fields.text());
    record.words(fields.words());
  }
  return bytes;
}

void compare_summary(const SummaryPart& summary, const DataFacts& data, Contents& contents) {
  SummaryCheck(data, contents).run(summary);
}

}  // namespace palpate::bag
