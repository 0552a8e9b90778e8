#include "apps/palpate/options/option_uses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/depth_file.hpp"
#include "apps/palpate/options/device_choice.hpp"
#include "apps/palpate/options/touch_surface.hpp"
#include "apps/palpate/options/touch_usage.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

// What sources are, all together.
struct Kinds {
  bool lives = false;
  bool still = false;          // a file, or made by the program
  bool recorded = false;       // and may begin anew
  bool image = false;          // a depth image in a file
  bool depth = false;          // has depths, whatever becomes of them
  bool filtered = false;       // goes through the depth filter
  bool filtered_live = false;  // frame by frame
  bool cloud = false;          // taken as points alone
  bool cloud_live = false;     // frame by frame
  bool history = false;        // by a policy that has one
};

// One that is not there, or a pipe, may be one.
bool may_be_image(const std::string& path) {
  std::error_code ignored;
  return !path.starts_with(kSynthetic) &&
         (!std::filesystem::is_regular_file(path, ignored) || is_depth_image(path));
}

Kinds kinds_of(const TouchOptions& options, std::span<const ChosenSource> sources) {
  Kinds kinds;
  for (const ChosenSource& source : sources) {
    const std::string& path = source.argument.path;
    const bool live = lives(path);
    const bool image = !live && is_depth_image(path);
    const bool organised = !live && !image && may_be_organised(path);
    const bool depth = live || image || organised;
    const bool cloud = !depth || organised || taken_as_cloud(options, source);
    kinds.lives |= live;
    kinds.still |= !live;
    kinds.recorded |= live && (!path.starts_with(kCamera) || path.ends_with(".oni"));
    kinds.image |= !live && may_be_image(path);
    kinds.depth |= depth;
    kinds.filtered |= depth && !taken_as_cloud(options, source);
    kinds.filtered_live |= live && !cloud;
    kinds.cloud |= cloud;
    kinds.cloud_live |= live && cloud;
    kinds.history |= live && keeps_history(policy_of(source_options(options, source), cloud));
  }
  return kinds;
}

// Options that not every run has a use for, and what they are of.
struct Use {
  std::vector<const char*> options;
  bool useful;
  const char* words;
};

std::vector<Use> uses_of_frames(const Kinds& kinds) {
  return {
      {{"--policy", "--history", "--silence", "--fade"},
       kinds.lives,
       "is of cameras and sequences; what stands still needs none"},
      {{"--history"},
       kinds.history,
       "is of the policies average and crossfade, and neither is chosen; add --policy average"},
      {{"--loop"}, kinds.recorded, "is of sequences, and there is none"},
      {{"--memory", "--fit-everywhere"},
       kinds.filtered_live,
       "is of frames that go through the depth filter, and none do"},
      {{"--clip-to-reach"},
       kinds.cloud_live,
       "is of frames that are taken as clouds; add --unorganised, or leave it out: the depth "
       "filter does its costly part within reach alone by itself"},
  };
}

std::vector<Use> uses_of_points(const Kinds& kinds) {
  return {
      {{"--scale"},
       kinds.still,
       "is of files; a camera tells its own, and a sequence has it in its sequence.json"},
      {{"--intrinsics", "--depth-unit"},
       kinds.image,
       "is of depth images; clouds need none, a camera tells its own, and a sequence has it in "
       "its sequence.json"},
      {{"--noise"}, kinds.depth, "is of depths, and there are none"},
      {{"--nearest", "--farthest"},
       kinds.filtered,
       "is of the depth filter, and nothing goes through it"},
      {{"--unorganised"},
       kinds.depth,
       "is of depth images and organised clouds, and there is none"},
      {{"--voxel", "--viewpoint"},
       kinds.cloud,
       "is of clouds; the depth filter chooses by itself what pixels and noise allow: leave it "
       "out, or add --unorganised"},
  };
}

std::vector<Use> uses_of_time(const TouchOptions& options, const Kinds& kinds) {
  const bool real_time = in_real_time(options);
  return {
      {{"--latency"},
       kinds.lives,
       "is of cameras and sequences; what stands still is there from the start"},
      {{"--latency"}, options.simulated_time, "is of simulated time; add --simulated-time"},
      {{"--view"},
       !options.simulated_time,
       "shows a run in real time; leave it or --simulated-time out"},
      {{"--no-view"}, !options.view.wanted, "contradicts --view; leave one of them out"},
      {{"--maximum-force", "--processor"},
       real_time && !options.simulated_time,
       "is of runs in real time; what stands still and --simulated-time have neither a guard nor a "
       "thread of the servo's own"},
      {{"--listen", "--port"}, has_page(options), "is of the page, and there is none; add --view"},
  };
}

std::vector<Use> uses_of_hand(const TouchOptions& options) {
  const std::vector<DeviceChoice> devices = choose_devices(options);
  const auto any = [&](DeviceKind kind) {
    return std::ranges::any_of(devices, [kind](const auto& each) { return each.kind == kind; });
  };
  const bool remote = any(DeviceKind::remote);
  const bool held = any(DeviceKind::hardware);
  const bool led = std::ranges::any_of(devices, &DeviceChoice::is_led);
  const bool exploring = led && options.trajectory.empty();
  return {
      {{"--trajectory"},
       led,
       "leads a scripted or simulated hand; a remote one goes where its program says, hardware "
       "where "
       "its hand does"},
      {{"--duration"},
       exploring || remote || held,
       "is of the exploration; a --trajectory has its own"},
      {{"--seed"},
       exploring,
       "is of the exploration; a --trajectory is played as it is, and a remote hand goes where its "
       "program says"},
      {{"--rate"},
       exploring || remote || any(DeviceKind::simulated),
       "is of the exploration or of --device simulated or remote; a --trajectory has its own"},
  };
}

void check(const std::vector<Use>& uses, const GivenOptions& given) {
  for (const Use& use : uses) {
    for (const char* option : use.options) {
      if (use.useful || !given.contains(option)) continue;
      throw UsageError(fmt::format("{} {}", option, use.words));
    }
  }
}

void check(const std::vector<Use>& uses, const DescribedOptions& described) {
  for (const Use& use : uses) {
    for (const char* option : use.options) {
      const auto found = described.find(option);
      if (use.useful || found == described.end()) continue;
      throw Error(fmt::format("{} {}", found->second, use.words));
    }
  }
}

}  // namespace

void check_use(const TouchOptions& options, const std::vector<ChosenSource>& sources) {
  const Kinds kinds = kinds_of(options, sources);
  for (const std::vector<Use>& uses : {uses_of_frames(kinds), uses_of_points(kinds)}) {
    check(uses, options.given);
    check(uses, options.described);
  }
  check(uses_of_time(options, kinds), options.given);
  check(uses_of_hand(options), options.given);
  for (const ChosenSource& source : sources) {
    const Kinds its = kinds_of(options, {&source, 1});
    check(uses_of_frames(its), source.described);
    check(uses_of_points(its), source.described);
  }
}

}  // namespace palpate::app
