#pragma once

#include <cstddef>

#include "bag/mcap_format.hpp"

namespace palpate::bag {

/// Records, compressed by zstd where that makes them smaller.
struct Packed {
  std::string compression;  ///< "zstd", or "" for none
  Bytes bytes;              ///< empty: the records as they are
};
[[nodiscard]] Packed pack(View records);

/// The records in the content of a chunk (Op::chunk), their CRC checked where it is stored.
/// @throws Error when they are damaged or grow beyond reason: beyond kLargestChunk, or beyond 16
/// MiB and 1000 times what they are packed in. No more than that is allocated.
[[nodiscard]] Bytes unpack(View chunk);

/// Gives each record in `records` to take(op, content, offset of the record).
/// @throws Error at the first that does not fit.
template <class Take>
void each_record(View records, Take&& take) {
  for (Fields fields(records); !fields.left().empty();) {
    const std::size_t offset = records.size() - fields.left().size();
    const auto op = static_cast<Op>(fields.number<std::uint8_t>());
    take(op, fields.bytes(fields.number<std::uint64_t>()), offset);
  }
}

/// A message from its record's content. @throws Error when that is too short.
[[nodiscard]] inline Message message_of(View content) {
  Fields fields(content);
  Message message;
  message.channel = fields.number<std::uint16_t>();
  message.sequence = fields.number<std::uint32_t>();
  message.stamp.log = fields.number<std::uint64_t>();
  message.stamp.publish = fields.number<std::uint64_t>();
  message.data = fields.left();
  return message;
}

}  // namespace palpate::bag
