#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/options/run_facts.hpp"
#include "apps/palpate/options/touch_plan.hpp"

namespace palpate::app {

class OptionTable;

/// A source, and the keys that its own part of a set-up file has.
struct DescribedSource {
  SourcePlan plan;
  DescribedOptions described = {};
};

/// What the options of `palpate touch` set: the plan, and what it is completed by.
struct TouchChoices {
  std::vector<std::string> sources = {};  ///< of the command line: [NAME=]PATH
  std::string setup = {};                 ///< file that describes a set-up
  std::vector<PoseArgument> poses = {};
  std::vector<DescribedSource> described_sources = {};  ///< of the set-up file
  SourcePlan every_source = {};  ///< of sources that the set-up file adds nothing to
  std::optional<FieldOptions::Kind> field = {};
  std::optional<FieldOptions::Gradient> gradient = {};
  std::optional<double> threshold = {};        ///< of the metaball
  std::optional<double> friction_static = {};  ///< the dynamic one unless given
  bool simulated_time = false;
  bool no_view = false;
  TouchPlan plan = {};  ///< without its sources
};

/// Registers those that list which sources there are, how they are read and where they stand.
void add_placed_sources(OptionTable& table, TouchChoices& choices);

/// Registers what runs in real time are held to.
void add_live_options(OptionTable& table, TimePlan& time);

/// Registers the recording of the run.
void add_record_option(OptionTable& table, OutputPlan& outputs);

/// Registers every option of `palpate touch` and every key of a set-up file.
void add_touch_options(OptionTable& table, TouchChoices& choices);

/// All of them on the command line of `palpate touch`, with its help.
void add_touch_command(CLI::App& command, TouchChoices& choices);

/// Reads a set-up file into `choices`, to which the options of `table` are bound, and fills in what
/// the command line did not give; notes which keys it has. Files in it are relative to its own
/// folder. docs/setup.md describes the file.
/// @throws Error that names file, line and key: of a key that is unknown, a value of another type
/// or out of range, a file that is no TOML.
void read_setup(const std::string& path, const OptionTable& table, const GivenOptions& given,
                TouchChoices& choices, DescribedOptions& described);

/// The set-up file's sources and then those of the command line; one of these that has the name of
/// one of the file's replaces it and keeps its pose and options. --pose wins over the file.
/// Fills in what depends on the whole surface.
/// @throws UsageError when there is none, two have one name, a pose names none of them, or options
/// of one contradict each other.
[[nodiscard]] std::vector<DescribedSource> choose_sources(const TouchChoices& choices,
                                                          const SurfacePlan& surface);

/// Adds one more source to `facts`.
void add_facts(RunFacts& facts, const SourcePlan& source);

}  // namespace palpate::app
