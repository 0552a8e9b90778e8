// Writes the end of an MCAP file: the summary that a reader needs without reading the data.
#include <algorithm>

#include "bag/mcap_writer.hpp"

namespace palpate::bag {

namespace {

// Behind a summary that begins at `summary` in `out`. The CRC counts the footer's own head in.
void append_footer(Bytes& out, std::size_t summary, std::uint64_t start, std::uint64_t offsets) {
  out.push_back(static_cast<std::uint8_t>(Op::footer));
  append(out, std::uint64_t{kFooter - kRecordHead});
  append(out, start);
  append(out, offsets);
  append(out, crc_of(View(out).subspan(summary)));
  out.insert(out.end(), kMagic.begin(), kMagic.end());
}

}  // namespace

void McapWriter::append_schema(Bytes& out, std::uint16_t number) const {
  const Schema& schema = schemas_[number - 1u];
  Record(out, Op::schema).numbers(number).text(schema.name).text(schema.encoding).text(schema.text);
}

void McapWriter::append_channel(Bytes& out, std::uint16_t number) const {
  const auto& [channel, schema, since, sequence, index] = channels_[number - 1u];
  Record record(out, Op::channel);
  record.numbers(number, schema).text(channel.topic).text(channel.message_encoding);
  record.words(channel.metadata);
}

Bytes McapWriter::ending(const Totals& totals, std::uint64_t at) const {
  Bytes out;
  Record(out, Op::data_end).numbers(std::uint32_t{0});
  const std::size_t summary = out.size();
  Bytes offsets;
  const auto group = [&](Op op, const auto& fill) {
    const std::size_t start = out.size();
    fill();
    if (out.size() == start) return;
    Record(offsets, Op::summary_offset)
        .numbers(static_cast<std::uint8_t>(op), at + start, std::uint64_t{out.size() - start});
  };
  const auto known = [&](const State& state) { return state.since < totals.chunks; };
  group(Op::schema, [&] {
    for (std::size_t i = 1; i <= schemas_.size(); ++i) {
      const auto uses = [&](const State& state) { return state.schema == i && known(state); };
      if (!std::ranges::any_of(channels_, uses)) continue;
      append_schema(out, static_cast<std::uint16_t>(i));
    }
  });
  group(Op::channel, [&] {
    for (std::size_t i = 1; i <= channels_.size(); ++i) {
      if (known(channels_[i - 1])) append_channel(out, static_cast<std::uint16_t>(i));
    }
  });
  group(Op::statistics, [&] { append_statistics(out, totals); });
  constexpr std::array kIndexes = {Op::chunk_index, Op::attachment_index, Op::metadata_index};
  for (std::size_t i = 0; i < kIndexes.size(); ++i) {
    group(kIndexes[i], [&] {
      const auto begin = index_[i].begin();
      out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(totals.indexed[i]));
    });
  }
  const std::uint64_t offsets_start = at + out.size();
  out.insert(out.end(), offsets.begin(), offsets.end());
  append_footer(out, summary, at + summary, offsets_start);
  return out;
}

void McapWriter::append_statistics(Bytes& out, const Totals& totals) const {
  const auto known = [&](const State& state) { return state.since < totals.chunks; };
  std::vector<bool> schemas(schemas_.size() + 1);
  for (const State& state : channels_)
    schemas[state.schema] = schemas[state.schema] || known(state);
  schemas[0] = false;
  Record record(out, Op::statistics);
  record.numbers(totals.messages, static_cast<std::uint16_t>(std::ranges::count(schemas, true)),
                 static_cast<std::uint32_t>(std::ranges::count_if(channels_, known)),
                 totals.attachments, totals.metadata, totals.chunks,
                 totals.messages > 0 ? totals.start : 0, totals.end);
  record.list([&] {
    for (std::size_t i = 0; i < totals.counts.size(); ++i) {
      if (!known(channels_[i])) continue;
      record.numbers(static_cast<std::uint16_t>(i + 1), totals.counts[i]);
    }
  });
}

}  // namespace palpate::bag
