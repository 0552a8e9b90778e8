#include "apps/palpate/sources/load.hpp"

#include <fmt/format.h>

#include <chrono>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate::app {

namespace {

CloudFile make_synthetic(const std::string& name, double scale) {
  CloudFile file;
  file.cloud = suggesting(name, synthetic_names(), [&] { return synthetic_cloud(name); });
  file.format = "made by palpate";
  file.declared = file.cloud.size();
  const auto factor = static_cast<float>(scale);
  for (Eigen::Vector3f& p : file.cloud.positions) p *= factor;
  if (file.cloud.viewpoint) *file.cloud.viewpoint *= scale;
  return file;
}

CloudFile read(const CloudArgument& argument, const ReadingOptions& options) {
  if (argument.path.starts_with(kSynthetic)) {
    return make_synthetic(argument.path.substr(kSynthetic.size()), options.scale);
  }
  ReadOptions read_options;
  read_options.scale = options.scale;
  read_options.depth_unit = options.depth_unit;
  if (!options.intrinsics.empty()) read_options.intrinsics = parse_intrinsics(options.intrinsics);
  Progress progress(fmt::format("reading {}", argument.path));
  read_options.progress = [&](double done) { progress.update(done); };
  return read_cloud_file(argument.path, read_options);
}

}  // namespace

LoadedCloud load(const CloudArgument& argument, const ReadingOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  LoadedCloud result{argument, read(argument, options), 0};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.file.cloud.empty()) {
    throw Error(
        fmt::format("{} holds no valid point ({} announced, {} dropped as invalid): there is "
                    "nothing to touch",
                    argument.path, result.file.declared, result.file.dropped));
  }
  return result;
}

}  // namespace palpate::app
