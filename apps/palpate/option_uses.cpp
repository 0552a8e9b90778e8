#include "apps/palpate/option_uses.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "apps/palpate/depth_file.hpp"
#include "apps/palpate/errors.hpp"
#include "apps/palpate/touch_surface.hpp"

namespace palpate::app {

namespace {

// What the sources are, all together.
struct Kinds {
  bool lives = false;
  bool still = false;          // a file, or made by the program
  bool recorded = false;       // and may begin anew
  bool depth = false;          // has depths, whatever becomes of them
  bool filtered = false;       // goes through the depth filter
  bool filtered_live = false;  // frame by frame
  bool cloud = false;          // taken as points alone
  bool cloud_live = false;     // frame by frame
};

Kinds kinds_of(const TouchOptions& options, const std::vector<ChosenSource>& sources) {
  Kinds kinds;
  for (const ChosenSource& source : sources) {
    const std::string& path = source.argument.path;
    const bool live = lives(path);
    const bool depth = live || is_depth_image(path);
    const bool cloud = !depth || taken_as_cloud(options, source);
    kinds.lives |= live;
    kinds.still |= !live;
    kinds.recorded |= live && (!path.starts_with("camera:") || path.ends_with(".oni"));
    kinds.depth |= depth;
    kinds.filtered |= !cloud;
    kinds.filtered_live |= live && !cloud;
    kinds.cloud |= cloud;
    kinds.cloud_live |= live && cloud;
  }
  return kinds;
}

// Options that not every run has a use for.
struct Use {
  std::vector<const char*> options;
  bool useful;
  const char* otherwise;
};

std::vector<Use> uses_of_frames(const Kinds& kinds) {
  return {
      {{"--policy", "--history", "--silence", "--fade"},
       kinds.lives,
       "--policy, --history, --silence and --fade are of cameras and sequences; what stands "
       "still needs none"},
      {{"--loop"}, kinds.recorded, "--loop is of sequences; no source is one"},
      {{"--predict", "--memory", "--fit-everywhere"},
       kinds.filtered_live,
       "--predict, and memory and fit_everywhere of a set-up, are of the depth filter's frames; no "
       "camera or sequence goes through it"},
      {{"--clip-to-reach"},
       kinds.cloud_live,
       "--clip-to-reach is of frames that are taken as clouds; add --unorganised, or leave it "
       "out: the depth filter does its costly part within reach alone by itself"},
  };
}

std::vector<Use> uses_of_points(const Kinds& kinds) {
  return {
      {{"--scale", "--intrinsics", "--depth-unit"},
       kinds.still,
       "--scale, --intrinsics and --depth-unit are of files; a camera tells its own, and a "
       "sequence has them in its sequence.json"},
      {{"--noise"}, kinds.depth, "--noise is of depths; no source has any"},
      {{"--nearest", "--farthest"},
       kinds.filtered,
       "--nearest and --farthest are of the depth filter; no source goes through it"},
      {{"--unorganised"}, kinds.depth, "--unorganised is of depth images; no source is one"},
      {{"--radius", "--voxel", "--viewpoint"},
       kinds.cloud,
       "--radius, --voxel and --viewpoint are of clouds; the depth filter chooses by itself what "
       "pixels and noise allow: leave them out, or add --unorganised"},
  };
}

std::vector<Use> uses_of_time(const TouchOptions& options, const Kinds& kinds) {
  return {
      {{"--latency"},
       kinds.lives,
       "--latency is of cameras and sequences; what stands still is there from the start"},
      {{"--latency"},
       options.simulated_time,
       "--latency is of simulated time; add --simulated-time"},
      {{"--view"},
       !options.simulated_time,
       "--view shows a run in real time; leave it or --simulated-time out"},
      {{"--maximum-force", "--processor"},
       (kinds.lives || options.view.wanted) && !options.simulated_time,
       "--maximum-force and --processor are of runs in real time; what stands still and "
       "--simulated-time have neither a guard nor a thread of the servo's own"},
  };
}

std::vector<Use> uses_of_hand(const TouchOptions& options) {
  const bool exploring = options.trajectory.empty();
  return {
      {{"--duration"}, exploring, "--duration is of the exploration; a --trajectory has its own"},
      {{"--seed"}, exploring, "--seed is of the exploration; a --trajectory is played as it is"},
      {{"--rate"},
       exploring || options.device == "simulated",
       "--rate is of the exploration or of --device simulated; a --trajectory has its own"},
  };
}

using Names = std::set<std::string, std::less<>>;

void check(const std::vector<Use>& uses, const Names& names) {
  for (const Use& use : uses) {
    const bool there = std::ranges::any_of(
        use.options, [&](const char* option) { return names.contains(option); });
    if (there && !use.useful) throw UsageError(use.otherwise);
  }
}

}  // namespace

void check_use(const TouchOptions& options, const std::vector<ChosenSource>& sources) {
  const Kinds kinds = kinds_of(options, sources);
  for (const Names& names : {options.given, options.described}) {
    check(uses_of_frames(kinds), names);
    check(uses_of_points(kinds), names);
  }
  check(uses_of_time(options, kinds), options.given);
  check(uses_of_hand(options), options.given);
}

}  // namespace palpate::app
