// Options that may differ from source to source.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "palpate/io/files.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

class OptionTable;

/// The kind of a source, from its name and its file's first bytes.
enum class SourceKind { cloud, depth_image, stream };

/// How a file is read.
struct FileReading : ReadOptions {
  bool chosen = false;  ///< its scale is of somebody on the page
};

/// A source that is to be touched: what it is, how it is read, prepared and treated in time.
struct SourcePlan {
  CloudArgument argument;
  SourceKind kind = SourceKind::cloud;
  FileReading reading;
  SourceOptions options;                ///< with its pose
  std::optional<double> farthest = {};  ///< depth, m; unset: chosen by the first frame
  bool as_cloud = false;                ///< depths are taken as points, not by the depth filter
  bool loop = false;                    ///< a sequence starts again at its end
  std::size_t cache = std::size_t{1} << 30U;  ///< bytes of memory for a store on disk; judgement
};

/// Sets the scale of "0.3048", or of "0.3048,1" with that of heights. @throws UsageError.
void take_scale(const std::string& text, ReadOptions& options);

/// Registers the options that set how the bytes of a file become points.
void add_reading_options(OptionTable& table, FileReading& options);

/// Registers the memory for a store, where it may stay on disk.
void add_cache_option(OptionTable& table, SourcePlan& source);

/// Registers the others of one source, of a [[source]] or of all.
void add_source_options(OptionTable& table, SourcePlan& source);

/// Help text for the sources of a command.
[[nodiscard]] std::string cloud_help();

/// A source for each scan of an E57 file, named NAME-1 and so on; the source alone where it is
/// another file, or has more than `most` scans, which are joined then.
/// @throws Error as scans_of() does.
[[nodiscard]] std::vector<CloudArgument> split_scans(const CloudArgument& source, std::size_t most);

/// The policy for a source's frames or clouds.
[[nodiscard]] Policy policy_of(const SourcePlan& source);

/// Is --history a policy's?
[[nodiscard]] bool keeps_history(Policy policy);

}  // namespace palpate::app
