// Writes MCAP files that can be read whenever the program or the machine stops.
#include "bag/mcap_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "bag/chunk.hpp"

namespace palpate::bag {

namespace {

constexpr std::size_t kSmallEnding = 256 << 10;  // bytes; written after each chunk (judgement)
// Bytes; leaves 16 MiB of a chunk for the rest (judgement)
constexpr std::size_t kLargestMessage = kLargestChunk - (16 << 20);
constexpr std::size_t kMostChannels = 65535;  // ids have 16 bits (derived)

// Whether `now` is `span` or more behind `since`; what was earlier is not.
bool is_over(std::uint64_t span, std::uint64_t since, std::uint64_t now) {
  return now > since && now - since >= span;
}

[[noreturn]] void refuse_to_create(const std::string& path) {
  throw Error(fmt::format("{}: cannot be created: {}; name a file in a folder that can be written",
                          path, std::strerror(errno)));
}

// An empty file; of two programs that write to one, the second is refused.
int open_empty(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) refuse_to_create(path);
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file);
    throw Error(fmt::format("{}: another program records to it; name another file", path));
  }
  if (::ftruncate(file, 0) == 0 || errno == EINVAL) return file;  // a device has no length
  const int why = errno;
  ::close(file);
  errno = why;
  refuse_to_create(path);
}

}  // namespace

std::string offered_qos(const message::Quality& quality) {
  // rmw's numbers. A time of INT64_MAX ns is none.
  constexpr const char* kNever = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return fmt::format(
      "- history: 1\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:{}  lifespan:{}"
      "  liveliness: 1\n  liveliness_lease_duration:{}  avoid_ros_namespace_conventions: false\n",
      quality.depth, quality.reliable ? 1 : 2, quality.stays ? 1 : 2, kNever, kNever, kNever);
}

McapWriter::McapWriter(std::string path, const Options& options)
    : path_(std::move(path)), options_(options), file_(open_empty(path_)) {
  Bytes data(kMagic.begin(), kMagic.end());
  Record(data, Op::header).text(options_.profile).text("palpate");
  try {
    commit(data, summary_.totals);
  } catch (const Error&) {
    ::close(file_);
    throw;
  }
}

McapWriter::~McapWriter() {
  try {
    if (!failed_) close();
  } catch (const Error&) {
    failed_ = true;
  }
  if (file_ >= 0) ::close(file_);
}

std::uint16_t McapWriter::add_channel(const Channel& channel) {
  if (summary_.channels.size() >= kMostChannels) {
    throw Error(fmt::format("{}: there are more than {} channels; record fewer topics", path_,
                            kMostChannels));
  }
  return summary_.add(channel);
}

void McapWriter::write(std::uint16_t channel, const Stamp& stamp, View data) {
  check_open();
  if (channel == 0 || channel > summary_.channels.size() || data.size() > kLargestMessage) {
    throw Error(
        fmt::format("{}: a message of {} bytes for channel {} is refused; there are {} "
                    "channels, and {} bytes are the most",
                    path_, data.size(), channel, summary_.channels.size(), kLargestMessage));
  }
  advance(stamp.log);
  McapSummary::ChannelState& state = summary_.channels[channel - 1u];
  if (chunk_.empty()) chunk_began_ = stamp.log;
  summary_.describe(chunk_, channel);
  state.index.emplace_back(stamp.log, chunk_.size());
  Record(chunk_, Op::message)
      .numbers(channel, state.sequence++, stamp.log, stamp.publish)
      .bytes(data);
  if (chunk_.size() >= options_.chunk_size) write_chunk();
}

void McapWriter::advance(std::uint64_t now) {
  check_open();
  if (!chunk_.empty() && is_over(options_.chunk_time, chunk_began_, now)) write_chunk();
  if (!began_) synced_ = now;
  began_ = true;
  if (!is_over(options_.sync_time, synced_, now)) return;
  synced_ = now;
  sync();
}

void McapWriter::write_chunk() {
  if (chunk_.empty()) return;
  McapSummary::Totals after = summary_.totals;
  std::uint64_t start = UINT64_MAX;
  std::uint64_t end = 0;
  for (std::size_t i = 0; i < summary_.channels.size(); ++i) {
    // Sorts by time, then by offset.
    std::ranges::sort(summary_.channels[i].index);
    for (const auto& [time, offset] : summary_.channels[i].index) {
      start = std::min(start, time);
      end = std::max(end, time);
    }
    after.counts[i] += summary_.channels[i].index.size();
    after.messages += summary_.channels[i].index.size();
  }
  after.start = std::min(after.start, start);
  after.end = std::max(after.end, end);
  ++after.chunks;
  Bytes data;
  append_chunk(data, start, end);
  commit(data, std::move(after));
  chunk_.clear();
  for (McapSummary::ChannelState& state : summary_.channels) state.index.clear();
}

// The chunk and the offsets of its messages; and where both are, for the file's end.
void McapWriter::append_chunk(Bytes& out, std::uint64_t start, std::uint64_t end) {
  Packed packed = options_.compressed ? pack(chunk_) : Packed{};
  const View bytes = packed.bytes.empty() ? View(chunk_) : View(packed.bytes);
  Record(out, Op::chunk)
      .numbers(start, end, std::uint64_t{chunk_.size()}, crc_of(chunk_))
      .text(packed.compression)
      .numbers(std::uint64_t{bytes.size()})
      .bytes(bytes);
  const std::uint64_t length = out.size();
  Record entry(summary_.index[0], Op::chunk_index);
  entry.numbers(start, end, end_, length);
  entry.list([&] {
    for (std::size_t i = 0; i < summary_.channels.size(); ++i) {
      if (summary_.channels[i].index.empty()) continue;
      const auto number = static_cast<std::uint16_t>(i + 1);
      entry.numbers(number, end_ + out.size());
      Record index(out, Op::message_index);
      index.numbers(number).list([&] {
        for (const auto& [time, offset] : summary_.channels[i].index) index.numbers(time, offset);
      });
    }
  });
  entry.numbers(std::uint64_t{out.size()} - length).text(packed.compression);
  entry.numbers(std::uint64_t{bytes.size()}, std::uint64_t{chunk_.size()});
}

void McapWriter::attach(const Attachment& attachment) {
  check_open();
  if (attachment.data.size() > kLargestChunk) {
    throw Error(
        fmt::format("{}: {} of {} MB is larger than the {} MB that readers take in one "
                    "piece",
                    path_, attachment.name, attachment.data.size() >> 20, kLargestChunk >> 20));
  }
  write_chunk();
  Bytes data;
  Record(data, Op::attachment)
      .numbers(attachment.log_time, attachment.create_time)
      .text(attachment.name)
      .text(attachment.media_type)
      .numbers(std::uint64_t{attachment.data.size()})
      .bytes(attachment.data)
      .crc();
  Record(summary_.index[1], Op::attachment_index)
      .numbers(end_, std::uint64_t{data.size()}, attachment.log_time, attachment.create_time,
               std::uint64_t{attachment.data.size()})
      .text(attachment.name)
      .text(attachment.media_type);
  McapSummary::Totals after = summary_.totals;
  ++after.attachments;
  commit(data, std::move(after));
}

void McapWriter::add(const Metadata& metadata) {
  check_open();
  write_chunk();
  Bytes data;
  Record(data, Op::metadata).text(metadata.name).words(metadata.words);
  Record(summary_.index[2], Op::metadata_index)
      .numbers(end_, std::uint64_t{data.size()})
      .text(metadata.name);
  McapSummary::Totals after = summary_.totals;
  ++after.metadata;
  commit(data, std::move(after));
}

// Puts `data` behind the data of the file and, mostly, closes it again.
void McapWriter::commit(Bytes& data, McapSummary::Totals after) {
  const std::uint64_t end = end_ + data.size();
  for (std::size_t i = 0; i < summary_.index.size(); ++i)
    after.indexed[i] = summary_.index[i].size();
  after.crc = static_cast<std::uint32_t>(crc32_z(after.crc, data.data(), data.size()));
  const bool ends = after.indexed[0] < kSmallEnding;
  if (ends) {
    const Bytes tail = summary_.ending(after, end);
    data.insert(data.end(), tail.begin(), tail.end());
  }
  if (::ftruncate(file_, static_cast<off_t>(end_)) != 0 || !put(end_, data)) give_up(errno);
  end_ = end;
  summary_.totals = std::move(after);
  ended_ = ends;
}

void McapWriter::close() {
  if (file_ < 0) return;
  check_open();
  write_chunk();
  sync();
  const int file = std::exchange(file_, -1);
  if (::close(file) != 0) give_up(errno);
}

// Writes the ending and flushes the file to disk.
void McapWriter::sync() {
  if (!ended_ && !put(end_, summary_.ending(summary_.totals, end_))) give_up(errno);
  ended_ = true;
  if (::fdatasync(file_) != 0 && errno != EINVAL) give_up(errno);  // EINVAL: a pipe, /dev/null
}

bool McapWriter::put(std::uint64_t at, const Bytes& data) const {
  for (std::size_t done = 0; done < data.size();) {
    const ssize_t written =
        ::pwrite(file_, data.data() + done, data.size() - done, static_cast<off_t>(at + done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    done += static_cast<std::size_t>(written);
  }
  return true;
}

void McapWriter::check_open() const {
  if (failed_ || file_ < 0) {
    throw Error(path_ + ": takes no more, since it was closed or could not be written");
  }
}

// Leaves the file as it was before what failed: there was room for that.
void McapWriter::give_up(int reason) {
  failed_ = true;
  const bool as_it_was = file_ >= 0 && ::ftruncate(file_, static_cast<off_t>(end_)) == 0 &&
                         put(end_, summary_.ending(summary_.totals, end_));
  throw Error(fmt::format(
      "{}: cannot be written: {}; {}. Free some space and record to another file", path_,
      std::strerror(reason),
      as_it_was ? fmt::format("it can be read and holds {} messages", summary_.totals.messages)
                : "'palpate bag recover' reads what it holds"));
}

}  // namespace palpate::bag
