// Recognises recordings of other kinds than MCAP.
#include "bag/other_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate::bag {

namespace {

struct Other {
  std::string_view start;
  std::string_view words;  // {}: the file's name
};

constexpr Other kOthers[] = {
    {"SQLite format 3",
     "is a recording of ROS 2 in an SQLite database, and MCAP files are read; make it one by "
     "'mcap convert {} run.mcap' (mcap.dev) or 'ros2 bag convert'"},
    {"#ROSBAG",
     "is a bag of ROS 1, and those of ROS 2 in MCAP files are read; make it one by "
     "'rosbags-convert --src {} --dst run --dst-storage mcap' (pip install rosbags)"},
    {"version https://git-lfs",
     "is a Git LFS pointer, not the file itself; download that by 'git lfs pull'"},
    {"\x28\xb5\x2f\xfd", "is compressed with zstd; unpack it by 'zstd -d {}'"},
};

}  // namespace

void refuse_other(const RandomFile& file) {
  constexpr std::uint64_t kHead = 32;  // bytes, more than what any of them begins with
  const Bytes head = file.read(0, std::min(file.size(), kHead));
  for (const Other& other : kOthers) {
    const View start = view_of(other.start);
    if (head.size() < start.size() || !std::equal(start.begin(), start.end(), head.begin())) {
      continue;
    }
    throw Error(
        fmt::format("{}: {}", file.path(), fmt::format(fmt::runtime(other.words), file.path())));
  }
  throw Error(file.path() + ": is no MCAP file; name one that ROS 2 or palpate recorded");
}

}  // namespace palpate::bag
