#pragma once

#include "bag/mcap_walk.hpp"

namespace palpate::bag {

/// Compares what an MCAP file states about itself with what it holds: the checksum of all of its
/// data and those of attachments, times, sizes and indexes of chunks, offsets of messages, and
/// counts. `contents` are those of a reader that has read all of the file; what differs is added to
/// their losses, and what these report is not reported again. Holds a chunk at a time, 16 bytes for
/// each message in it, and some hundred bytes for each chunk of the file.
void check(const RandomFile& file, Contents& contents);

}  // namespace palpate::bag
