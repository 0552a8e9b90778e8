// Writes Potree 2.0 stores step by step, so that a run that was stopped goes on.
#include "extras/tile/tile.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <span>
#include <string_view>

#include "extras/tile/out_file.hpp"
#include "extras/tile/plan.hpp"
#include "extras/tile/store_builder.hpp"
#include "io/file_bytes.hpp"
#include "palpate/base/error.hpp"

namespace palpate::io::tile {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJob = "job.txt";
constexpr const char* kMetadata = "metadata.json";

// Describes what makes the bytes of a store what they are: the inputs' names in the first line.
std::string job_of(const std::vector<std::string>& inputs, const TileOptions& options) {
  std::string names;
  const ReadOptions& reading = options.reading;
  std::string details = fmt::format("scale {}, {} of heights, {} points a chunk, {} a leaf\n",
                                    reading.scale.value_or(0), reading.height_scale.value_or(0),
                                    options.chunk_points, options.leaf_points);
  for (const std::string& path : inputs) {
    names += (names.empty() ? "" : " ") + path;
    struct stat status {};
    if (::stat(split_scan(path).file.c_str(), &status) != 0) continue;
    details += fmt::format("{} bytes, changed at {}.{:09}\n", status.st_size, status.st_mtim.tv_sec,
                           status.st_mtim.tv_nsec);
  }
  return names + "\n" + details;
}

class Tiler {
 public:
  Tiler(const std::vector<std::string>& inputs, const fs::path& out, const TileOptions& options)
      : paths_(inputs),
        out_(out),
        work_(out / "unfinished"),
        options_(options),
        job_(job_of(inputs, options)) {}

  TileResult run() {
    make_folder();
    const Locked lock(work_);
    refuse_others_files();
    const bool goes_on = was_begun();
    std::vector<TileInput> inputs;
    for (const std::string& path : paths_) inputs.push_back(open_input(path, options_.reading));
    const Plan plan = make_plan(inputs, options_.chunk_points, reporter("counting"));
    if (!goes_on) begin();
    if (!fs::exists(work_ / kMetadata)) build(inputs, plan);
    publish();
    constexpr double kSpacings = 128;  // along the edge of a node (format)
    TileResult result{{},
                      plan.points,
                      plan.dropped,
                      fs::file_size(out_ / "octree.bin"),
                      plan.frame.step,
                      plan.frame.edge() / kSpacings};
    for (const TileInput& input : inputs) {
      if (!input.format.empty()) {
        result.inputs.push_back({input.name, input.format, input.unit, input.box});
      }
    }
    return result;
  }

 private:
  void make_folder() const {
    std::error_code error;
    const bool complete = fs::exists(out_ / kMetadata, error) && !fs::exists(work_ / kJob, error);
    if (complete && !options_.force) {
      throw Error(out_.string() + " is complete; --force replaces it.");
    }
    fs::create_directories(work_, error);
    if (error) {
      throw Error(fmt::format("{}: cannot be made ({}). Name another folder.", work_.string(),
                              error.message()));
    }
  }

  // A folder of this name that somebody else made is not to be emptied, even with --force.
  void refuse_others_files() const {
    if (fs::exists(work_ / kJob)) return;
    for (const auto& each : fs::directory_iterator(work_)) {
      // A run may have been stopped while it wrote this.
      if (each.path().filename().string().starts_with(kJob)) continue;
      throw Error(each.path().string() + ": palpate did not write it. Name another folder.");
    }
  }

  // Keeps the file that names the job, and metadata.json, without which what was moved is no store.
  void clear_folder() const {
    for (const auto& each : fs::directory_iterator(work_)) {
      const fs::path name = each.path().filename();
      if (name != kJob && name != kMetadata) fs::remove_all(each);
    }
  }

  // Did an earlier run begin the same?
  [[nodiscard]] bool was_begun() const {
    if (!fs::exists(work_ / kJob)) return false;
    const Bytes bytes = read_bytes(work_ / kJob);
    const std::string_view earlier(reinterpret_cast<const char*>(bytes.span().data()),
                                   bytes.size());
    if (earlier != job_ && !options_.force) throw Error(difference(earlier));
    return earlier == job_;
  }

  void begin() const {
    fs::remove(work_ / kMetadata);
    clear_folder();
    write_file(work_ / kJob, {std::as_bytes(std::span(job_))});
  }

  [[nodiscard]] std::string difference(std::string_view earlier) const {
    const std::string_view names = earlier.substr(0, earlier.find('\n'));
    const bool same = names == job_.substr(0, job_.find('\n'));
    return fmt::format("{} was begun with {}. {}, or start anew with --force.", out_.string(),
                       same ? "other options, or its inputs have changed since"
                            : fmt::format("other inputs: {}", names),
                       same ? "Give the same options" : "Give these");
  }

  void build(const std::vector<TileInput>& inputs, const Plan& plan) const {
    if (!fs::exists(work_ / "points")) {
      check_space(plan);
      distribute(inputs, plan, work_ / "sorting", reporter("sorting into chunks"));
      fs::rename(work_ / "sorting", work_ / "points");
    }
    StoreBuilder builder(plan, options_.leaf_points, work_);
    builder.sort_chunks(reporter("building the octree"));
    builder.finish(fs::path(paths_.front()).stem().string());
    report("finishing", 0);
  }

  // The files of chunks go while octree.bin grows, so that all points are there once, two chunks
  // and the roots twice.
  void check_space(const Plan& plan) const {
    constexpr std::uint64_t kOthers = std::uint64_t{64} << 20U;  // bytes, judgement
    const std::uint64_t points = plan.points * plan.layout.size();
    const std::uint64_t needed = points + points / 4 + kOthers;
    fs::remove_all(work_ / "sorting");
    const std::uint64_t free =
        options_.free_bytes ? options_.free_bytes(work_) : fs::space(work_).available;
    if (free >= needed) return;
    const auto size = [](std::uint64_t bytes) {
      return fmt::format("{:.3g} GB", 1e-9 * static_cast<double>(bytes));
    };
    throw Error(fmt::format("tile needs {} in {}, {} are free. Make room or name another folder.",
                            size(needed), out_.string(), size(free)));
  }

  // Moves the files to where they belong, metadata.json last: it makes a store of them. Before
  // that, nothing is left of which another run could think that it has to go on with it.
  void publish() const {
    fs::remove(out_ / kMetadata);
    for (const char* const file : {"octree.bin", "hierarchy.bin"}) {
      if (fs::exists(work_ / file)) fs::rename(work_ / file, out_ / file);
      report("finishing", 0.5);
    }
    clear_folder();
    fs::rename(work_ / kMetadata, out_ / kMetadata);
    report("finishing", 1);
    fs::remove_all(work_);
  }

  void report(const std::string& step, double done) const {
    if (options_.progress) options_.progress(step, done);
  }
  [[nodiscard]] Report reporter(const std::string& step) const {
    return [this, step](double done) { report(step, done); };
  }

  std::vector<std::string> paths_;
  fs::path out_;
  fs::path work_;
  const TileOptions& options_;
  std::string job_;
};

}  // namespace

TileResult tile(const std::vector<std::string>& inputs, const fs::path& out,
                const TileOptions& options) {
  return Tiler(inputs, out, options).run();
}

}  // namespace palpate::io::tile
