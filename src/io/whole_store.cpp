// Reads all of a point store into memory.
#include "io/whole_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "geometry/parallel.hpp"
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

template <class T>
void append(std::vector<T>& all, const std::vector<T>& part, std::size_t total) {
  if (part.empty()) return;
  all.reserve(total);
  all.insert(all.end(), part.begin(), part.end());
}

// `total`: points that there will be.
void append(PointCloud& cloud, const PointCloud& part, std::size_t total) {
  append(cloud.positions, part.positions, total);
  append(cloud.normals, part.normals, total);
  append(cloud.colors, part.colors, total);
  append(cloud.intensities, part.intensities, total);
}

// A column that some points lack is none.
void drop_incomplete(PointCloud& cloud) {
  const auto check = [&](auto& column) {
    if (column.size() != cloud.size()) column = {};
  };
  check(cloud.normals);
  check(cloud.colors);
  check(cloud.intensities);
}

// Nodes from `first` on. Where several are damaged, the first one's error is thrown.
std::vector<PointCloud> read_some(const PointStore& store, std::size_t first, std::size_t count) {
  std::vector<PointCloud> parts(count);
  std::vector<std::exception_ptr> errors(count);
  detail::parallel_each(count, 1, [&](std::size_t i) {
    try {
      parts[i] = store.read(first + i);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return parts;
}

}  // namespace

CloudFile read_whole(const PointStore& store, const Input& input) {
  constexpr std::size_t kAtOnce = 64;  // nodes: enough for all cores, few for memory (judgement)
  const PointStore::Layout& layout = store.layout();
  check_memory(input, layout.points);
  CloudFile file;
  file.format = layout.format;
  file.declared = layout.points;
  file.cloud.origin = layout.origin;
  Progress progress(input.options, layout.nodes.size());
  for (std::size_t first = 0; first < layout.nodes.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, layout.nodes.size() - first);
    for (const PointCloud& part : read_some(store, first, count)) {
      append(file.cloud, part, layout.points);
    }
    progress.at(first + count);
  }
  drop_incomplete(file.cloud);
  file.dropped = file.declared - file.cloud.size();
  check_not_empty(input, file.cloud.size(), file.dropped);
  return file;
}

}  // namespace palpate::io
