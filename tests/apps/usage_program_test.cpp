#include <gtest/gtest.h>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

TEST(Usage, HelpAndVersionSucceed) {
  Shell shell;
  const Outcome help = shell.run("--help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("touch"), std::string::npos);
  const Outcome touch = shell.run("touch --help");
  EXPECT_EQ(touch.code, 0);
  EXPECT_EQ(touch.out.find("{false}"), std::string::npos);
  for (const char* word : {"--trajectory", "--pose", "Examples:", "Exit codes", "torus", "N/M"}) {
    EXPECT_NE(touch.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(shell.run("info --help").code, 0);
  const Outcome version = shell.run("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.find("palpate "), 0u);
  for (const char* word : {"revision", "built by", "OpenNI2", "documents"}) {
    EXPECT_NE(version.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(shell.run("-V").out, version.out);
  EXPECT_EQ(shell.run("version").out, version.out);
  EXPECT_EQ(shell.run("help").out, help.out);
  EXPECT_EQ(shell.run("help touch").out, touch.out);
  EXPECT_EQ(shell.run("help tuoch").code, 2);
}

TEST(Usage, WrongCommandLinesEndWithTwoAndSayWhy) {
  Shell shell;
  shell.write("two.toml", "[left]\nmass = 1\n[right]\nmass = 2\n");
  shell.write("long.csv", "t,hip_x,hip_y,hip_z\n0,0,0,0\n1e300,0,0,0\n");
  const std::pair<const char*, const char*> cases[] = {
      {"",
       "touch, align, info, tile, bag, replay, cameras, devices, ros, doctor, paper, demo or "
       "zwidth"},
      {"touch synthetic:torus --device simulated --trajectory long.csv", "1e+300"},
      {"tuch synthetic:torus", "not expected: tuch synthetic:torus; did you mean touch?"},
      {"bag cut.mcap", "not expected: cut.mcap; put one of info, recover before it"},
      {"touch", "no source given"},
      {"touch synthetic:torus --colour red", "--colour"},
      {"touch synthetic:torus --field mesh", "'mesh' is not one of balanced, pointset, metaball"},
      {"touch synthetic:torus --field balancd", "did you mean balanced?"},
      {"touch camera:simulated --policy avrage", "did you mean average?"},
      {"demo rom", "did you mean room?"},
      {"touch synthetic:torus --radius -1", "above 0"},
      {"touch synthetic:torus --radius nan", "above 0"},
      {"touch synthetic:torus --stiffness stiff", "stiff"},
      {"touch synthetic:torus --viewpoint 1,2", "x,y,z"},
      {"touch synthetic:torus --pose ring=0,0,0,0,0,0,1", "torus"},
      {"touch synthetic:torus --pose torus=0,0,0,0,0,0,2", "quaternion"},
      {"touch synthetic:torus --pose torus=0,0,0", "qx,qy,qz,qw"},
      {"touch synthetic:torus --intrinsics 1,2,3", "fx,fy,cx,cy"},
      {"touch synthetic:torus --friction-static 0.1 --friction-dynamic 0.3", "--friction-static"},
      {"touch synthetic:torus --soft-stiffness 900 --trajectory long.csv", "--soft-stiffness"},
      {"touch synthetic:torus --soft-stiffness 900 --stiffness 800", "--soft-stiffness"},
      {"touch a=synthetic:torus a=synthetic:sheet", "'a'"},
      {"touch synthetic:torus --friction-static 0 --friction-dynamic 0.3", "--friction-static"},
      {"touch synthetic:torus --gradient printed", "--field metaball"},
      {"touch synthetic:torus --gradient normal --field metaball", "--gradient normal"},
      {"touch synthetic:torus --gradient normal --preset paper", "--gradient normal"},
      {"touch synthetic:torus --preset paper --tool-radius 0.003", "--tool-radius"},
      {"touch synthetic:torus --tool-radius 0.003 --radius 0.0099", "0.01"},
      {"touch synthetic:torus --trajectory long.csv --duration 3", "--duration"},
      {"touch synthetic:torus --trajectory long.csv --seed 3", "--seed"},
      {"touch synthetic:torus --picture -", "--picture"},
      {"touch synthetic:torus --picture a.jpg", "name it a.png"},
      {"info synthetic:torus --picture a.jpg", "name it a.png"},
      {"info synthetic:torus camera:simulated --picture a.png", "camera:simulated"},
      {"tile a.las", "--out is required"},
      {"tile --out b", "clouds is required"},
      {"zwidth --picture a.pdf", "name it a.png"},
      {"zwidth --profiles two.toml", "two.toml has left, right; say which by --device-profile"},
      {"touch synthetic:torus --seed 1 --seed 2", "--seed is given 2 times; give it once"},
      {"paper fig5 --picture -", "--picture"},
      {"touch synthetic:torus --stiffness 1e308", "at most 1e9"},
      {"touch synthetic:torus --texture-amplitude 1", "--texture-amplitude"},
      {"touch - -", "only once"},
      {"touch synthetic:torus --policy average", "--policy"},
      {"touch synthetic:torus --loop", "--loop"},
      {"touch synthetic:torus --latency 0.1", "--latency"},
      {"touch synthetic:torus --noise xtion", "--noise"},
      {"touch synthetic:torus --unorganised", "--unorganised"},
      {"touch camera:simulated --voxel 0.01", "--unorganised"},
      {"touch camera:simulated --loop", "--loop"},
      {"touch camera:simulated --depth-unit 0.1", "sequence.json"},
      {"touch synthetic:torus --view --simulated-time", "real time"},
      {"touch synthetic:torus --seed -1", "whole number"},
      {"touch synthetic:torus --seed 1.5", "whole number"},
      {"touch synthetic:torus --radius inf", "not finite"},
      {"touch synthetic:torus --raduis 0.1", "did you mean --radius?"},
      {"info --jsno a.json", "did you mean --json?"},
      {"touch camera:simulated --predict", "--predict"},
      {"touch synthetic:torus --nearest 0.5", "--nearest"},
      {"touch camera:simulated --nearest 3 --farthest 2", "--farthest 2"},
      {"touch camera:simulated --clip-to-reach", "--unorganised"},
      {"touch synthetic:torus --maximum-force 3", "real-time runs"},
      {"touch camera:simulated --simulated-time --processor 0", "real-time runs"},
      {"touch camera:simulated --processor -1", "from 0"},
      {"touch camera:simulated --maximum-force 0", "above 0"},
      {"touch synthetic:torus --rate 100", "between 500 and 10000"},
      {"touch synthetic:torus --trajectory long.csv --rate 2000", "--rate"},
      {"touch camera:simulated --policy smear", "smear"},
      {"touch camera:simulated --history 8", "1 to 7"},
      {"touch camera:simulated --history 3", "average and crossfade"},
      {"touch synthetic:torus --intrinsics 60,60,31,23", "depth images"},
      {"touch synthetic:torus --depth-unit 0.01", "depth images"},
      {"touch synthetic:torus --port 8500", "--view"},
      {"touch camera:simulated --simulated-time --listen 127.0.0.1", "--view"},
      {"touch synthetic:torus --view --listen 1.2.3", "--listen: '1.2.3'"},
      {"touch synthetic:torus --view --no-view", "--no-view"},
      {"touch sequence:", "'sequence:'"},
      {"touch a=camera: --simulated-time", "'camera:'"},
      {"touch synthetic:", "'synthetic:'"},
      {"info sequence:", "'sequence:'"},
      {"touch ''", "''"},
      {"touch camera:simulated --noise 1,2", "--noise"},
      {"touch camera:simulated --noise 1,2,3,0.5", "--noise"},
      {"touch camera:simulated --noise radar", "radar"},
      {"touch camera:simulated --unorganised --policy morph", "--policy morph"},
      {"touch synthetic:torus --log - --json -", "standard output"},
      {"info", "clouds"},
  };
  for (const auto& [arguments, word] : cases) {
    const Outcome outcome = shell.run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
}

TEST(Usage, InputAtFaultEndsWithOneAndNamesIt) {
  Shell shell;
  shell.write("empty.ply", "");
  shell.write("text.ply", "this is no cloud\n");
  shell.write("plane.xyz", plane_xyz());
  shell.write("grey.pgm", "P5\n2 2\n255\nabcd");
  shell.write("bad.csv", "t,hip_x,hip_y,hip_z\n0,0,0,0\n0,1,1,1\n");
  shell.write("far.csv", "t,hip_x,hip_y,hip_z\n0,0,0,0\n1,1e10,1,1\n");
  const std::pair<const char*, const char*> cases[] = {
      {"touch missing.ply", "missing.ply"},
      {"touch empty.ply", "empty.ply"},
      {"touch text.ply", "text.ply"},
      {"touch synthetic:horse", "torus"},
      {"touch synthetic:tours", "did you mean torus?"},
      {"touch synthetic:torus --radius 1e9", "--radius 1e+09 is too large"},
      {"zwidth --device-profile omgea", "did you mean omega?"},
      {"touch plane.xyz --trajectory missing.csv", "missing.csv"},
      {"touch plane.xyz --trajectory bad.csv", "line 3"},
      {"touch plane.xyz --soft-stiffness 100", "intensity"},
      {"touch plane.xyz --trajectory far.csv", "row 1"},
      {"touch p=plane.xyz --pose p=1e12,0,0,0,0,0,1", "from the origin"},
      {"touch plane.xyz --scale 1e13", "from the origin"},
      {"touch plane.xyz --log nowhere/log.csv", "nowhere/log.csv"},
      {"touch plane.xyz --duration 0.1 --picture nowhere/a.png", "nowhere/a.png"},
      {"info missing.ply", "missing.ply"},
      {"touch grey.pgm", "values up to 255"},
      {"touch camera:simulated,noise=a", "write simulated:table,noise=a"},
      {"touch --setup .", ".: is no file"},
  };
  for (const auto& [arguments, word] : cases) {
    const Outcome outcome = shell.run(arguments);
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace palpate::app
