#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "palpate/io/cloud_file.hpp"
#include "palpate/scene/source.hpp"

namespace palpate::app {

class OptionTable;

/// What a source is, as far as its name and its file's first bytes tell.
enum class SourceKind { cloud, depth_image, stream };

/// A source that is to be touched: what it is, how it is read, prepared and treated in time.
struct SourcePlan {
  CloudArgument argument;
  SourceKind kind = SourceKind::cloud;
  ReadOptions reading;
  SourceOptions options;                ///< with its pose
  std::optional<double> farthest = {};  ///< depth, m; unset: chosen by the first frame
  bool as_cloud = false;                ///< depths are taken as points, not by the depth filter
  bool loop = false;                    ///< a sequence starts again at its end
};

/// Registers the options that say how the bytes of a file become points.
void add_reading_options(OptionTable& table, ReadOptions& options);

/// Registers those of one source, of a [[source]] or of all.
void add_source_options(OptionTable& table, SourcePlan& source);

/// What a command takes as sources, for its help.
[[nodiscard]] std::string cloud_help();

/// The set-up file's sources and then those of the command line; one of these that has the name of
/// one of the file's takes its place and keeps its pose and options. --pose wins over the file.
/// What depends on the whole surface is filled in.
/// @throws UsageError when there is none, two have one name, a pose names none of them, or options
/// of one contradict each other.
[[nodiscard]] std::vector<DescribedSource> choose_sources(const TouchChoices& choices,
                                                          const SurfacePlan& surface);

/// Tells in `facts` of one more source.
void add_facts(RunFacts& facts, const SourcePlan& source);

/// What becomes of a source's frames or clouds in time.
[[nodiscard]] Policy policy_of(const SourcePlan& source);

/// Is --history a policy's?
[[nodiscard]] bool keeps_history(Policy policy);

}  // namespace palpate::app
