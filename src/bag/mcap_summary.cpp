// Writes the end of an MCAP file: the summary that a reader needs without reading the data.
#include "bag/mcap_summary.hpp"

#include <algorithm>

namespace palpate::bag {

namespace {

using ChannelState = McapSummary::ChannelState;

// Behind a summary that begins at `summary` in `out`. The CRC counts the footer's own head in.
void append_footer(Bytes& out, std::size_t summary, std::uint64_t start, std::uint64_t offsets) {
  out.push_back(static_cast<std::uint8_t>(Op::footer));
  append(out, std::uint64_t{kFooter - kRecordHead});
  append(out, start);
  append(out, offsets);
  append(out, crc_of(View(out).subspan(summary)));
  out.insert(out.end(), kMagic.begin(), kMagic.end());
}

void append_schema(Bytes& out, const McapSummary& summary, std::uint16_t number) {
  const Schema& schema = summary.schemas[number - 1u];
  Record(out, Op::schema).numbers(number).text(schema.name).text(schema.encoding).text(schema.text);
}

void append_channel(Bytes& out, const McapSummary& summary, std::uint16_t number) {
  const auto& [channel, schema, since, sequence, index] = summary.channels[number - 1u];
  Record record(out, Op::channel);
  record.numbers(number, schema).text(channel.topic).text(channel.message_encoding);
  record.words(channel.metadata);
}

void append_statistics(Bytes& out, const McapSummary& summary, const McapSummary::Totals& totals) {
  const auto described = [&](const ChannelState& state) { return state.since < totals.chunks; };
  std::vector<bool> schemas(summary.schemas.size() + 1);
  for (const ChannelState& state : summary.channels)
    schemas[state.schema] = schemas[state.schema] || described(state);
  schemas[0] = false;
  Record record(out, Op::statistics);
  record.numbers(totals.messages, static_cast<std::uint16_t>(std::ranges::count(schemas, true)),
                 static_cast<std::uint32_t>(std::ranges::count_if(summary.channels, described)),
                 totals.attachments, totals.metadata, totals.chunks,
                 totals.messages > 0 ? totals.start : 0, totals.end);
  record.list([&] {
    for (std::size_t i = 0; i < totals.counts.size(); ++i) {
      if (!described(summary.channels[i])) continue;
      record.numbers(static_cast<std::uint16_t>(i + 1), totals.counts[i]);
    }
  });
}

}  // namespace

std::uint16_t McapSummary::add(const Channel& channel) {
  std::uint16_t schema = 0;  // none
  if (channel.schema != Schema{}) {
    auto found = std::ranges::find(schemas, channel.schema);
    if (found == schemas.end()) found = schemas.insert(found, channel.schema);
    schema = static_cast<std::uint16_t>(found - schemas.begin() + 1);
  }
  channels.push_back({.channel = channel, .schema = schema, .index = {}});
  totals.counts.push_back(0);
  return static_cast<std::uint16_t>(channels.size());
}

void McapSummary::describe(Bytes& out, std::uint16_t number) {
  ChannelState& state = channels[number - 1u];
  if (state.since != UINT64_MAX) return;
  state.since = totals.chunks;
  const auto has = [&](const ChannelState& other) {
    return &other != &state && other.schema == state.schema && other.since != UINT64_MAX;
  };
  if (state.schema != 0 && std::ranges::none_of(channels, has)) {
    append_schema(out, *this, state.schema);
  }
  append_channel(out, *this, number);
}

Bytes McapSummary::ending(const Totals& after, std::uint64_t at) const {
  Bytes out;
  Record(out, Op::data_end).numbers(after.crc);
  const std::size_t summary = out.size();
  Bytes offsets;
  const auto group = [&](Op op, const auto& fill) {
    const std::size_t start = out.size();
    fill();
    if (out.size() == start) return;
    Record(offsets, Op::summary_offset)
        .numbers(static_cast<std::uint8_t>(op), at + start, std::uint64_t{out.size() - start});
  };
  const auto described = [&](const ChannelState& state) { return state.since < after.chunks; };
  group(Op::schema, [&] {
    for (std::size_t i = 1; i <= schemas.size(); ++i) {
      const auto uses = [&](const ChannelState& state) {
        return state.schema == i && described(state);
      };
      if (!std::ranges::any_of(channels, uses)) continue;
      append_schema(out, *this, static_cast<std::uint16_t>(i));
    }
  });
  group(Op::channel, [&] {
    for (std::size_t i = 1; i <= channels.size(); ++i) {
      if (described(channels[i - 1])) append_channel(out, *this, static_cast<std::uint16_t>(i));
    }
  });
  group(Op::statistics, [&] { append_statistics(out, *this, after); });
  constexpr std::array kIndexes = {Op::chunk_index, Op::attachment_index, Op::metadata_index};
  for (std::size_t i = 0; i < kIndexes.size(); ++i) {
    group(kIndexes[i], [&] {
      const auto begin = index[i].begin();
      out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(after.indexed[i]));
    });
  }
  const std::uint64_t offsets_start = at + out.size();
  out.insert(out.end(), offsets.begin(), offsets.end());
  append_footer(out, summary, at + summary, offsets_start);
  return out;
}

}  // namespace palpate::bag
