// Reads the octree of COPC files, and the points of its nodes.
#include "io/copc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/store_nodes.hpp"
#include "io/laz/laz_file.hpp"
#include "io/laz/points.hpp"
#include "io/text_scanner.hpp"

namespace palpate::io {
namespace {

constexpr std::string_view kMakeAgain =
    "Make it again, for example with \"pdal translate IN.laz OUT.copc.laz\"";

// Offsets into the record "copc", and its bytes.
constexpr std::size_t kHalfSize = 24;
constexpr std::size_t kSpacing = 32;
constexpr std::size_t kRootOffset = 40;
constexpr std::size_t kRootSize = 48;
constexpr std::size_t kInfoSize = 160;

constexpr std::size_t kEntrySize = 32;  // bytes of an entry of a page
constexpr std::int32_t kDeepest = 30;   // level: 30 bits of a coordinate's 32 (judgement)

class CopcReader {
 public:
  CopcReader(const Input& head, const LasHeader& header, const Parts& file, std::size_t info)
      : head_(head), header_(header), file_(file), info_(info) {}

  Copc run() {
    const std::byte* info = head_.bytes.data() + info_;
    for (int k = 0; k < 3; ++k) copc_.center[k] = load_as<double>(info + 8 * k);
    copc_.half_size = load_as<double>(info + kHalfSize);
    copc_.spacing = load_as<double>(info + kSpacing);
    // The sum bounds the corners of all cubes, so that these are finite, too.
    const double farthest = copc_.center.cwiseAbs().sum() + 2 * copc_.half_size;
    const bool possible = std::isfinite(farthest) && copc_.half_size > 0 &&
                          std::isfinite(copc_.spacing) && copc_.spacing > 0;
    if (!possible) wrong(info_, "an octree without a finite size, center and spacing");
    add_page(info_ + kRootOffset, load_as<std::uint64_t>(info + kRootOffset),
             load_as<std::uint64_t>(info + kRootSize));
    while (!pages_.empty()) read_page();
    check_nodes();
    return std::move(copc_);
  }

 private:
  struct Page {
    std::size_t offset = 0;
    std::size_t bytes = 0;
  };

  // `at`: the byte that stores where the page is.
  void add_page(std::size_t at, std::uint64_t offset, std::uint64_t bytes) {
    const std::size_t size = file_.size;
    if (offset > size || bytes > size - offset || bytes % kEntrySize != 0) {
      wrong(at, fmt::format("a page of {} bytes at byte {} of a file of {}", bytes, offset, size));
    }
    if (!known_pages_.insert(offset).second) {
      wrong(at, fmt::format("the page at byte {} is listed twice", offset));
    }
    page_bytes_ += bytes;  // so pages that overlap cannot grow without end
    if (page_bytes_ > size) wrong(at, "more bytes in pages than in the file");
    pages_.push_back({static_cast<std::size_t>(offset), static_cast<std::size_t>(bytes)});
  }

  void read_page() {
    const Page page = pages_.back();
    pages_.pop_back();
    const Bytes entries = file_.read(page.offset, page.bytes);
    for (std::size_t offset = 0; offset < page.bytes; offset += kEntrySize) {
      const std::byte* entry = entries.span().data() + offset;
      const std::size_t at = page.offset + offset;
      StoredNode node;
      node.node.level = load_as<std::int32_t>(entry);
      for (std::size_t k = 0; k < 3; ++k) {
        node.node.cell[k] = load_as<std::int32_t>(entry + 4 + 4 * k);
      }
      const auto begin = load_as<std::uint64_t>(entry + 16);
      const auto bytes = load_as<std::int32_t>(entry + 24);
      const auto points = load_as<std::int32_t>(entry + 28);
      if (bytes < 0 || points < -1) wrong(at, "a node of fewer than 0 bytes or points");
      node.bytes = static_cast<std::size_t>(bytes);
      if (points < 0) {
        add_page(at, begin, node.bytes);
      } else {
        node.offset = begin;
        node.node.points = static_cast<std::size_t>(points);
        add_node(at, node);
      }
    }
  }

  void add_node(std::size_t at, const StoredNode& node) {
    const auto& [level, cell, points] = node.node;
    if (level < 0 || level > kDeepest || std::ranges::any_of(cell, [top = level](std::int32_t c) {
          return c < 0 || c >> top != 0;
        })) {
      wrong(at,
            fmt::format("no cube of level {} is at {}, {}, {}", level, cell[0], cell[1], cell[2]));
    }
    const std::size_t size = file_.size;
    const bool outside = node.offset > size || node.bytes > size - node.offset;
    if (points > 0 && (outside || !laz::can_hold(header_, node.bytes, points))) {
      wrong(at, fmt::format("a node of {} points in {} bytes at byte {} of a file of {}", points,
                            node.bytes, node.offset, size));
    }
    copc_.nodes.push_back(node);
  }

  void check_nodes() {
    std::vector<StoredNode>& nodes = copc_.nodes;
    const auto key = [](const StoredNode& each) { return detail::key_of(each.node); };
    std::ranges::sort(nodes, {}, key);
    const auto twice = std::ranges::adjacent_find(nodes, {}, key);
    if (twice != nodes.end()) wrong(info_, name_of(twice->node) + " is listed twice");
    std::size_t points = 0;
    for (const StoredNode& each : nodes) {
      points += each.node.points;
      const detail::NodeKey parent = detail::above(key(each));
      if (parent.first >= 0 && !std::ranges::binary_search(nodes, parent, {}, key)) {
        wrong(info_, name_of(each.node) + " is listed, but its parent is not");
      }
    }
    if (points != header_.points) {
      wrong(info_, fmt::format("the nodes have {} points, but the header announces {}", points,
                               header_.points));
    }
    // Nodes may share bytes: each holds its points, but not all of them together.
    if (!laz::can_hold(header_, file_.size, points)) {
      wrong(info_, fmt::format("{} points in a file of {} bytes, which cannot hold them", points,
                               file_.size));
    }
  }

  [[noreturn]] void wrong(std::size_t at, std::string_view what) const {
    fail_at_byte(head_, at, what, kMakeAgain);
  }

  const Input& head_;
  const LasHeader& header_;
  const Parts& file_;
  std::size_t info_;  // offset of the record "copc"
  Copc copc_;
  std::vector<Page> pages_;  // still to be read
  std::set<std::size_t> known_pages_;
  std::size_t page_bytes_ = 0;
};

}  // namespace

std::optional<Copc> read_copc(const Input& head, const LasHeader& header, const Parts& file) {
  const std::optional<LasRecord> info = find_record(head, header, "copc", 1);
  if (!info || info->size < kInfoSize || !header.compressed || !header.extended()) {
    return std::nullopt;
  }
  (void)laz::read_chunk_size(head, header);  // throws for what is not read
  return CopcReader(head, header, file, info->offset).run();
}

std::string name_of(const PointStore::Node& node) {
  return fmt::format("node {}-{}-{}-{}", node.level, node.cell[0], node.cell[1], node.cell[2]);
}

std::vector<LasPoint> decode_node(const Input& head, const LasHeader& header,
                                  std::span<const std::byte> bytes, const StoredNode& node) {
  std::vector<LasPoint> points(node.node.points);
  if (points.empty()) return points;
  laz::require_whole(head, node.offset, name_of(node.node),
                     laz::decode_points(header, bytes, points), points.size());
  return points;
}

}  // namespace palpate::io
