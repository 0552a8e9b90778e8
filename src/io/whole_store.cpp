// Reads all of a point store into memory.
#include "io/whole_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "geometry/store_nodes.hpp"
#include "io/cloud_builder.hpp"

namespace palpate::io {
namespace {

// Bytes a point: 12 of position, 3 of colour, 4 of intensity, and the same in an index (derived).
constexpr std::size_t kPointMemory = 2 * (12 + 3 + 4);

constexpr double kGigabyte = 1e9;

// Bytes that Linux can give to programs without taking any from others; nothing: unknown.
std::optional<std::size_t> free_memory() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  std::size_t kilobytes = 0;
  std::string unit;
  while (file >> name >> kilobytes && std::getline(file, unit)) {
    if (name == "MemAvailable:") return kilobytes * 1024;
  }
  return std::nullopt;
}

void check_memory(const Input& input, std::size_t points) {
  const std::optional<std::size_t> available = free_memory();
  if (!available || points <= *available / kPointMemory) return;
  const double needed = static_cast<double>(points) * static_cast<double>(kPointMemory);
  fail(input,
       fmt::format("holds {} points and would need about {:.1f} GB of memory; {:.1f} GB are free",
                   points, needed / kGigabyte, static_cast<double>(*available) / kGigabyte),
       "Make a store of fewer points, or use a machine with more memory");
}

}  // namespace

CloudFile read_whole(const PointStore& store, const Input& input) {
  constexpr std::size_t kAtOnce = 64;  // nodes: enough for all cores, few for memory (judgement)
  const PointStore::Layout& layout = store.layout();
  check_memory(input, layout.points);
  CloudFile file;
  file.format = layout.format;
  file.unit = layout.unit;
  file.declared = layout.points;
  file.cloud.origin = layout.origin;
  Progress progress(input.options, layout.nodes.size());
  for (std::size_t first = 0; first < layout.nodes.size(); first += kAtOnce) {
    std::vector<std::size_t> some(std::min(kAtOnce, layout.nodes.size() - first));
    std::iota(some.begin(), some.end(), first);
    for (const PointCloud& part : detail::read_nodes(store, some)) {
      detail::append(part, file.cloud, layout.points);
    }
    progress.at(first + some.size());
  }
  file.dropped = file.declared - file.cloud.size();
  check_not_empty(input, file.cloud.size(), file.dropped);
  return file;
}

}  // namespace palpate::io
