// What a run has of options, and which parts of it they depend on.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

namespace palpate::app {

/// Options that a command line has, as "--rate".
using GivenOptions = std::set<std::string, std::less<>>;

/// Options that a set-up file has, as "--noise", each with where: "desk.toml, line 3: 'noise'".
using DescribedOptions = std::map<std::string, std::string, std::less<>>;

/// The parts of a run that options depend on.
struct RunFacts {
  // One source at least ...
  bool stream = false;           ///< is a camera or sequence
  bool is_static = false;        ///< is a file, or made by the program
  bool recorded = false;         ///< is a recording, which may be repeated
  bool image = false;            ///< is a depth image in a file
  bool depth = false;            ///< has depths, whatever becomes of them
  bool filtered = false;         ///< goes through the depth filter ...
  bool filtered_frames = false;  ///< ... frame by frame
  bool cloud = false;            ///< is taken as points alone ...
  bool cloud_frames = false;     ///< ... frame by frame
  bool history = false;          ///< has a policy that keeps several clouds

  bool simulated_time = false;  ///< was requested ...
  bool any_time = false;        ///< ... or not
  bool guarded = false;         ///< in real time, with a guard and a servo's thread
  bool robot = false;           ///< a robot follows its proxy
  bool page = false;            ///< has a page
  bool page_unasked = false;    ///< --view does not request one
  bool follows = false;         ///< a hand follows a trajectory or an exploration ...
  bool explores = false;        ///< ... an exploration
  bool trajectory = false;      ///< ... a trajectory,
  bool played = false;          ///< ... exactly, row by row
  bool has_duration = false;    ///< a hand explores, or has no end of its own
  bool has_rate = false;        ///< a hand's steps a second can be chosen
  bool turns = false;           ///< the hands hold a tool that turns ...
  bool points = false;          ///< ... or points
};

/// The part of a run that an option applies to; a run without it refuses the option.
struct Scope {
  bool RunFacts::*applies;
  const char* words;  ///< behind the option's name: what it applies to, and what to do
};

/// For what a run in real time has.
inline constexpr Scope kGuarded{&RunFacts::guarded,
                                "applies only to real-time runs; remove it: static sources and "
                                "--simulated-time use no guard or servo thread"};

/// For what is of a tool that turns.
inline constexpr Scope kTurns{&RunFacts::turns, "is for a tool that turns; add --tool"};
/// For what a tool that turns does not render.
inline constexpr Scope kPoints{&RunFacts::points,
                               "is for a point; a tool that turns does not have it: remove it or "
                               "--tool"};

}  // namespace palpate::app
