// Writes Potree 2.0 stores step by step, so that a run that was stopped goes on.
#include "io/tile/tile.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstring>
#include <optional>

#include "io/file_bytes.hpp"
#include "io/tile/chunk_files.hpp"
#include "io/tile/in_order.hpp"
#include "io/tile/metadata.hpp"
#include "io/tile/out_file.hpp"
#include "io/tile/state.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNodeBytes = 25;  // of a settled node in the list of nodes
constexpr std::size_t kRootHead = 9;    // bytes before the points of a chunk's root
constexpr std::size_t kAtOnce = 2;      // chunks that are sorted side by side, for memory

void put(const StoreNode& node, std::span<std::byte> bytes) {
  LittleEndianWriter out(bytes);
  out.put(static_cast<std::uint8_t>(node.cell.level));
  for (const std::uint32_t at : node.cell.at) out.put(at);
  out.put(node.points);
  out.put(node.place);
}

StoreNode node_at(const std::byte* bytes) {
  return {{std::to_integer<int>(bytes[0]), numbers_of(bytes + 1)},
          load_as<std::uint32_t>(bytes + 13),
          load_as<std::uint64_t>(bytes + 17)};
}

// A chunk that is sorted; its root may still lose points to the levels above.
struct Grown {
  Settled settled;
  Branch root;
};

// Sorts the chunks and joins them: from the files of chunks to the store's own.
class Builder {
 public:
  Builder(State& state, const fs::path& work, const TileOptions& options)
      : state_(state),
        plan_(state.plan),
        work_(work),
        options_(options),
        octree_(work / "octree.bin", state.octree),
        nodes_(work / "nodes", state.nodes),
        roots_(work / "roots", state.roots) {}

  void sort_chunks(const Told& told) {
    const std::size_t first = state_.chunks;
    in_order(
        plan_.chunks.size() - first, kAtOnce, [&](std::size_t i) { return grown(first + i); },
        [&](Grown& each) {
          take(each);
          told(static_cast<double>(state_.chunks) / static_cast<double>(plan_.chunks.size()));
        });
  }

  // Adds the levels above the chunks, and writes what describes the store.
  void finish(const std::string& name) {
    const OpenFile roots((work_ / "roots").string());
    const Bytes listed = OpenFile((work_ / "nodes").string()).read(0, state_.nodes);
    std::vector<StoreNode> nodes;
    for (std::size_t at = 0; at < listed.size(); at += kNodeBytes) {
      nodes.push_back(node_at(listed.span().data() + at));
    }
    Joiner joiner(plan_.layout, plan_.frame.bits);
    Settled settled;
    const auto settle = [&] {
      append(settled);
      nodes.insert(nodes.end(), settled.nodes.begin(), settled.nodes.end());
      settled = {};
    };
    std::size_t chunk = 0;
    std::size_t place = 0;  // of the chunk's root
    const std::function<Branch(const Cell&)> branch_at = [&](const Cell& cell) {
      if (plan_.chunks[chunk].cell == cell) {
        ++chunk;
        return root_at(roots, cell, place);
      }
      std::vector<Branch> children;
      for (unsigned i = 0; i < 8; ++i) {
        const Cell child = cell.child(i);
        if (chunk < plan_.chunks.size() && is_within(plan_.chunks[chunk].cell, child)) {
          children.push_back(branch_at(child));
        }
      }
      Branch parent = joiner.join(cell, std::move(children), settled);
      settle();
      return parent;
    };
    settled.add(branch_at({}), plan_.layout);
    settle();
    octree_.sync();
    const Hierarchy hierarchy = hierarchy_of(std::move(nodes), plan_.layout);
    const std::string metadata = metadata_of(plan_, hierarchy, name);
    write_file(work_ / "hierarchy.bin", hierarchy.bytes);
    write_file(work_ / "metadata.json", std::as_bytes(std::span(metadata)));
  }

 private:
  [[nodiscard]] Grown grown(std::size_t i) const {
    const Chunk& chunk = plan_.chunks[i];
    const std::size_t size = chunk.points * plan_.layout.size();
    std::vector<std::byte> records;
    {
      const Bytes unsorted = OpenFile(chunk_file(work_ / "points", i)).read(0, size);
      records = sort_records(unsorted.span(), plan_.layout, chunk.cell, plan_.frame.bits);
    }
    Grown grown;
    grown.settled.bytes.reserve(size);
    Joiner joiner(plan_.layout, plan_.frame.bits);
    grown.root = joiner.grow(chunk.cell, records, options_.leaf_points, grown.settled);
    return grown;
  }

  // What is on the disk before tile.json says so is cut off again after a stop.
  void take(Grown& grown) {
    append(grown.settled);
    std::vector<std::byte> listed(kNodeBytes * grown.settled.nodes.size());
    for (std::size_t i = 0; i < grown.settled.nodes.size(); ++i) {
      put(grown.settled.nodes[i], std::span(listed).subspan(i * kNodeBytes));
    }
    nodes_.append(listed);
    std::array<std::byte, kRootHead> head;
    LittleEndianWriter out(head);
    out.put(static_cast<std::uint8_t>(grown.root.inner));
    out.put(std::uint64_t{grown.root.records.size()});
    roots_.append(head);
    roots_.append(grown.root.records);
    for (const OutFile* each : {&octree_, &nodes_, &roots_}) each->sync();
    state_.octree = octree_.size();
    state_.nodes = nodes_.size();
    state_.roots = roots_.size();
    ++state_.chunks;
    save(state_, work_ / "tile.json");
    fs::remove(chunk_file(work_ / "points", state_.chunks - 1));
  }

  void append(Settled& settled) {
    for (StoreNode& node : settled.nodes) node.place += octree_.size();
    octree_.append(settled.bytes);
  }

  [[nodiscard]] bool is_within(const Cell& cell, const Cell& around) const {
    return cell.level >= around.level && cell_of(cell.at, around.level, cell.level) == around;
  }

  [[nodiscard]] Branch root_at(const OpenFile& roots, const Cell& cell, std::size_t& place) const {
    const Bytes head = roots.read(place, kRootHead);
    const std::size_t size = load_as<std::uint64_t>(head.span().data() + 1);
    const Bytes records = roots.read(place + kRootHead, size);
    place += kRootHead + size;
    return {cell, head.span()[0] != std::byte{0}, {records.span().begin(), records.span().end()}};
  }

  State& state_;
  const Plan& plan_;
  fs::path work_;
  const TileOptions& options_;
  OutFile octree_;
  OutFile nodes_;
  OutFile roots_;
};

NamedInput name_input(const std::string& path) {
  struct stat status {};
  const std::string file = split_scan(path).file;
  if (::stat(file.c_str(), &status) != 0) return {path};
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  return {path, static_cast<std::uint64_t>(status.st_size),
          status.st_mtim.tv_sec * kNanoseconds + status.st_mtim.tv_nsec};
}

class Tiler {
 public:
  Tiler(const std::vector<std::string>& inputs, const fs::path& out, const TileOptions& options)
      : paths_(inputs),
        out_(out),
        work_(out / "unfinished"),
        options_(options),
        job_{{}, options.scale, options.chunk_points, options.leaf_points} {
    for (const std::string& path : inputs) job_.inputs.push_back(name_input(path));
  }

  TileResult run() {
    make_folder();
    const Locked lock(work_);
    begin();
    if (!state_.finished) build();
    publish();
    return result();
  }

 private:
  void make_folder() const {
    if (fs::exists(out_ / "metadata.json") && !fs::exists(work_ / "tile.json") && !options_.force) {
      throw Error(out_.string() + " is complete; --force replaces it.");
    }
    std::error_code error;
    fs::create_directories(work_, error);
    if (error) {
      throw Error(fmt::format("{}: cannot be made ({}). Name another folder.", work_.string(),
                              error.message()));
    }
  }

  // Finds how far an earlier run came, or plans.
  void begin() {
    if (std::optional<State> earlier = earlier_state()) {
      state_ = std::move(*earlier);
      return;
    }
    for (const auto& each : fs::directory_iterator(work_)) fs::remove_all(each);
    state_ = {.job = job_,
              .plan = make_plan(open_inputs(), options_.chunk_points, told("counting"))};
    save(state_, work_ / "tile.json");
  }

  std::optional<State> earlier_state() const {
    try {
      std::optional<State> earlier = load_state(work_ / "tile.json");
      if (!earlier || earlier->job == job_) return earlier;
      throw Error(difference(earlier->job));
    } catch (const Error&) {
      if (options_.force) return std::nullopt;
      throw;
    }
  }

  [[nodiscard]] std::string difference(const Job& earlier) const {
    const auto names = [](const Job& job) {
      std::string text;
      for (const NamedInput& each : job.inputs) text += (text.empty() ? "" : " ") + each.name;
      return text;
    };
    const bool same = names(earlier) == names(job_);
    return fmt::format("{} was begun with {}. {}, or start anew with --force.", out_.string(),
                       same ? "other options, or its inputs have changed since"
                            : "other inputs: " + names(earlier),
                       same ? "Give the same options" : "Give these");
  }

  void build() {
    if (!state_.distributed) {
      check_space();
      distribute(open_inputs(), state_.plan, work_ / "points", told("sorting into chunks"));
      state_.distributed = true;
      save(state_, work_ / "tile.json");
    }
    Builder builder(state_, work_, options_);
    builder.sort_chunks(told("building the octree"));
    builder.finish(fs::path(paths_.front()).stem().string());
    tell("finishing", 0);
    state_.finished = true;
    save(state_, work_ / "tile.json");
  }

  // The files of chunks go while octree.bin grows, so that all points are there once, two chunks
  // and the roots twice.
  void check_space() const {
    constexpr std::uint64_t kOthers = std::uint64_t{64} << 20U;  // bytes, judgement
    const std::uint64_t points = state_.plan.points * state_.plan.layout.size();
    const std::uint64_t needed = points + points / 4 + kOthers;
    fs::remove_all(work_ / "points");
    const std::uint64_t free =
        options_.free_bytes ? options_.free_bytes(work_) : fs::space(work_).available;
    if (free >= needed) return;
    const auto size = [](std::uint64_t bytes) {
      return fmt::format("{:.3g} GB", 1e-9 * static_cast<double>(bytes));
    };
    throw Error(fmt::format("tile needs {} in {}, {} are free. Make room or name another folder.",
                            size(needed), out_.string(), size(free)));
  }

  // Moves the files to where they belong, metadata.json last: it makes a store of them.
  void publish() {
    if (fs::exists(work_ / "metadata.json")) fs::remove(out_ / "metadata.json");
    constexpr std::array kFiles{"octree.bin", "hierarchy.bin", "metadata.json"};
    for (std::size_t i = 0; i < kFiles.size(); ++i) {
      if (fs::exists(work_ / kFiles[i])) fs::rename(work_ / kFiles[i], out_ / kFiles[i]);
      tell("finishing", static_cast<double>(i + 1) / kFiles.size());
    }
    fs::remove_all(work_);
  }

  [[nodiscard]] TileResult result() const {
    constexpr double kSpacings = 128;  // along the edge of a node (format)
    const Plan& plan = state_.plan;
    return {plan.points, plan.dropped, fs::file_size(out_ / "octree.bin"), plan.frame.step,
            plan.frame.edge() / kSpacings};
  }

  [[nodiscard]] Inputs open_inputs() const {
    Inputs inputs;
    for (const std::string& path : paths_) inputs.push_back(open_input(path, options_.scale));
    return inputs;
  }

  void tell(const std::string& step, double done) const {
    if (options_.progress) options_.progress(step, done);
  }
  [[nodiscard]] Told told(const std::string& step) const {
    return [this, step](double done) { tell(step, done); };
  }

  std::vector<std::string> paths_;
  fs::path out_;
  fs::path work_;
  const TileOptions& options_;
  Job job_;
  State state_;
};

}  // namespace

TileResult tile(const std::vector<std::string>& inputs, const fs::path& out,
                const TileOptions& options) {
  return Tiler(inputs, out, options).run();
}

}  // namespace palpate::io::tile
