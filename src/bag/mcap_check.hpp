#pragma once

#include "bag/mcap_walk.hpp"

namespace palpate::bag {

/// Compares what an MCAP file says of itself with what it holds: the checksum of all of its data
/// and those of attachments, times, sizes and indexes of chunks, places of messages, and counts.
/// `contents` are those of a reader that has read all of the file; what differs is added to their
/// losses, and what these tell is not told again. Holds a chunk at a time, 16 bytes for each
/// message in it, and some hundred bytes for each chunk of the file.
void check(const RandomFile& file, Contents& contents);

}  // namespace palpate::bag
