// Writes Potree 2.0 stores step by step, so that a run that was stopped goes on.
#include "io/tile/tile.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstring>
#include <optional>

#include "io/tile/chunk_files.hpp"
#include "io/tile/out_file.hpp"
#include "io/tile/store_builder.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;

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
    refuse_others_files();
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

  // A folder of this name that somebody else made is not to be emptied, even with --force.
  void refuse_others_files() const {
    if (fs::exists(work_ / "tile.json")) return;
    for (const auto& each : fs::directory_iterator(work_)) {
      // A run may have been stopped while it wrote its first tile.json.
      if (each.path().filename().string().starts_with("tile.json")) continue;
      throw Error(each.path().string() + ": palpate did not write it. Name another folder.");
    }
  }

  // tile.json goes last: it says whose files these are.
  void clear_folder() const {
    for (const auto& each : fs::directory_iterator(work_)) {
      if (each.path().filename() != "tile.json") fs::remove_all(each);
    }
    fs::remove(work_ / "tile.json");
  }

  // Finds how far an earlier run came, or plans.
  void begin() {
    if (std::optional<State> earlier = earlier_state()) {
      state_ = std::move(*earlier);
      return;
    }
    clear_folder();
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
    StoreBuilder builder(state_, work_);
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
    clear_folder();
    fs::remove(work_);
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
