#include <gtest/gtest.h>

#include "apps/setup_parsed.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

std::string complaint(const Shell& shell, const std::string& toml) {
  try {
    (void)planned(shell, toml, "");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(SetupErrors, NameFileLineAndKey) {
  const Shell shell;
  struct Case {
    const char* toml;
    std::vector<const char*> words;
  };
  const Case cases[] = {
      {"[surface]\nfield = \"pointset\"\nraduis = 0.01\n",
       {"line 3", "'raduis'", "did you mean 'radius'?", "keys are radius", "field"}},
      {"[surfaces]\nradius = 1\n", {"line 1", "'surfaces'", "did you mean 'surface'?"}},
      {"[hand]\nradius = 1\n",
       {"line 2", "not a key of [hand]", "belongs to [[source]], [surface]"}},
      {"[material]\nsurface_colour = 1\n", {"line 2", "'surface_colour'", "keys are stiffness"}},
      {"[surface]\nradius = \"wide\"\n", {"line 2", "'radius'", "text", "a number"}},
      {"[surface]\n\nradius = -0.5\n", {"line 3", "'radius'", "above 0"}},
      {"[surface]\nradius = nan\n", {"line 2", "'radius'", "not finite", "above 0"}},
      {"[stream]\nsilence = inf\n", {"line 2", "'silence'", "not finite"}},
      {"[stream]\nmemory = 0\n", {"line 2", "'memory'", "from 1 to 255"}},
      {"[stream]\nmemory = -1\n", {"line 2", "'memory'", "'-1'", "from 1 to 255"}},
      {"[stream]\nhistory = -1\n", {"line 2", "'history'", "'-1'"}},
      {"[stream]\nclip_to_reach = \"yes\"\n",
       {"line 2", "'clip_to_reach'", "text", "true or false"}},
      {"[stream]\nnearest = 0\n", {"line 2", "'nearest'", "0.001 m or more"}},
      {"[stream]\nnoise = [1, inf, 1]\n", {"line 2", "'noise'", "not a finite number"}},
      {"[stream]\nnoise = \"radar\"\n", {"line 2", "'noise'", "radar"}},
      {"[stream]\npolicy = \"\"\n", {"line 2", "'policy'", "empty"}},
      {"[surface]\nnormal_error = 1\n", {"line 2", "'normal_error'", "0.2 rad"}},
      {"[reading]\nviewpoint = [0, 1]\n", {"line 2", "'viewpoint'", "2 numbers instead of 3"}},
      {"[guard]\nmaximum_force = 0\n", {"line 2", "'maximum_force'", "above 0"}},
      {"[guard]\nmaximum_force = inf\n", {"line 2", "'maximum_force'", "not finite"}},
      {"[guard]\nslew = -300\n", {"line 2", "'slew'", "above 0"}},
      {"[guard]\nwatchdog = 5\n", {"line 2", "'watchdog'", "0.001 to 1 s"}},
      {"[guard]\nforce = 3\n", {"line 2", "not a key of [guard]", "maximum_force"}},
      {"[servo]\nprocessor = -1\n", {"line 2", "'processor'", "'-1'", "from 0"}},
      {"[servo]\nprocessor = 1.0\n", {"line 2", "'processor'", "a whole number"}},
      {"[servo]\npriority = 100\n", {"line 2", "'priority'", "from 1 to 99"}},
      {"[servo]\nrealtime = 1\n", {"line 2", "'realtime'", "true or false"}},
      {"[surface]\nfield = 3\n", {"line 2", "'field'", "a whole number", "text"}},
      {"[surface]\nfield = \"mesh\"\n", {"line 2", "'field'", "mesh"}},
      {"[stream]\nhistory = 2.5\n", {"line 2", "'history'", "a whole number"}},
      {"[stream]\nhistory = 9\n", {"line 2", "'history'", "1 to 7"}},
      {"[stream]\nloop = 1\n", {"line 2", "'loop'", "true or false"}},
      {"[hand]\ndevice = 3\n", {"line 2", "'device'", "text in quotes, or a list"}},
      {"[hand]\ndevice = []\n", {"line 2", "'device'", "empty"}},
      {"[hand]\ndevice = [\"simulated\", 3]\n", {"line 2", "'device'", "text in quotes"}},
      {"[hand]\ndevice = \"falcon\"\n", {"line 2", "'device'", "falcon", "remote"}},
      {"[hand]\nseed = -1\n", {"line 2", "'seed'", "'-1'", "whole number from 0"}},
      {"[hand]\nseed = 1.5\n", {"line 2", "'seed'", "a whole number"}},
      {"[hand]\nseed = 9223372036854775807\n", {"line 2", "'seed'", "whole number from 0"}},
      {"[[source]]\nfrom = \"\"\n", {"line 2", "'from'", "empty"}},
      {"[[source]]\nfrom = \"a.ply\"\npose = [0, 0, nan, 0, 0, 0, 1]\n",
       {"line 3", "not a finite number"}},
      {"[[source]]\nfrom = \"a.ply\"\nclip_to_raech = true\n",
       {"line 3", "did you mean 'clip_to_reach'?"}},
      {"[[source]]\nfrom = \"a.ply\"\n[[source]]\nname = \"b\"\n", {"line 3", "'from'"}},
      {"[[source]]\nfrom = \"sequence:\"\n", {"line 2", "'from'", "'sequence:'"}},
      {"[[source]]\nfrom = \"a.ply\"\npose = [1, 2]\n",
       {"line 3", "'pose' of [[source]]", "2 numbers are no pose", "write x,y,z,qx"}},
      {"[[source]]\nfrom = \"a.ply\"\npose = [0, 0, 0, 0, 0, 0, 2]\n",
       {"line 3: 'pose' of [[source]]: the quaternion"}},
      {"[[source]]\nfrom = \"a.ply\"\nintrinsics = [1, \"x\"]\n",
       {"line 3", "'intrinsics'", "text"}},
      {"[[source]]\nfrom = \"a.ply\"\nfield = \"metaball\"\n", {"line 3", "'field'", "[[source]]"}},
      {"[[source]]\nfrom = \"a.ply\"\nname = \"a b\"\n", {"line 3", "'name'", "a b"}},
      {"[[source]]\nname = \"a\"\nfrom = \"a\"\n[[source]]\nname = \"a\"\nfrom = \"b\"\n",
       {"line 4", "two sources", "'a'"}},
      {"source = \"a.ply\"\n", {"line 1", "[[source]]"}},
      {"surface = 3\n", {"line 1", "'surface'", "[surface]"}},
      {"[surface\n", {"line 1", "TOML"}},
  };
  for (const Case& each : cases) {
    const std::string text = complaint(shell, each.toml);
    EXPECT_NE(text.find("desk.toml"), std::string::npos) << each.toml << "\n" << text;
    for (const char* word : each.words) {
      EXPECT_NE(text.find(word), std::string::npos) << each.toml << "\n" << text << "\n" << word;
    }
  }
}

TEST(SetupErrors, KeysThatNothingHasAUseForAreToldWithFileAndLine) {
  Shell shell;
  const std::string torus = "[[source]]\nfrom = \"synthetic:torus\"\n";
  const std::string camera = "[[source]]\nfrom = \"camera:simulated\"\n";
  const std::pair<std::string, const char*> cases[] = {
      {torus + "[stream]\nnoise = \"xtion\"\n",
       "desk.toml, line 4: 'noise' applies only to depth images"},
      {torus + "depth_unit = 0.1\n" + camera,
       "desk.toml, line 3: 'depth_unit' applies only to depth images"},
      {torus + camera + "voxel = 0.01\n", "desk.toml, line 5: 'voxel' applies only to clouds"},
      {camera + "[stream]\nhistory = 3\n",
       "desk.toml, line 4: 'history' applies only to the policies"},
  };
  for (const auto& [toml, words] : cases) {
    shell.write("desk.toml", toml);
    const Outcome outcome = shell.run("touch --setup desk.toml --simulated-time");
    EXPECT_EQ(outcome.code, 1) << toml << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }
  shell.write("desk.toml", "[[source]]\nname = \"a\"\nfrom = \"camera:simulated\"\nfade = 1\n");
  EXPECT_EQ(shell.run("touch --setup desk.toml a=synthetic:torus --duration 0.1").code, 0)
      << "the key was the camera's";
}

TEST(SetupErrors, TypesHaveToBeRightEvenWhereTheCommandLineWins) {
  const Shell shell;
  EXPECT_THROW((void)planned(shell, "[surface]\nradius = \"wide\"\n", "--radius 0.01"), Error);
}

TEST(SetupErrors, OneThatIsNotThereIsAnError) {
  EXPECT_THROW((void)planned("--setup nowhere.toml"), Error);
}

}  // namespace
}  // namespace palpate::app
