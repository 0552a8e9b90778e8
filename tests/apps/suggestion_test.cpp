#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {
namespace {

TEST(Suggestion, IsTheNameThatIsAFewLettersAway) {
  const std::vector<std::string> names = {"radius", "rate", "voxel", "scale"};
  EXPECT_EQ(meant("radius", names), "radius");
  EXPECT_EQ(meant("raduis", names), "radius");
  EXPECT_EQ(meant("radus", names), "radius");
  EXPECT_EQ(meant("radiuss", names), "radius");
  EXPECT_EQ(meant("boxel", names), "voxel");
  EXPECT_EQ(meant("sacle", names), "scale");
}

TEST(Suggestion, NothingIsSuggestedForWhatIsNotNear) {
  EXPECT_EQ(meant("colour", {"radius", "voxel"}), "");
  EXPECT_EQ(meant("ab", {"cd"}), "");
  EXPECT_EQ(meant("", {"radius"}), "");
  EXPECT_EQ(meant("radius", {}), "");
}

TEST(Suggestion, FirstWordsCount) {
  const std::vector<std::string> options{"--duration", "--friction-static", "--friction-dynamic"};
  EXPECT_EQ(meant("--frction", options), "--friction-static");
  EXPECT_EQ(meant("--duraton", options), "--duration");
}

TEST(Suggestion, IsAskedForWhereOneIsNear) {
  EXPECT_EQ(did_you_mean("tours", {"sheet", "torus"}), "; did you mean torus?");
  EXPECT_EQ(did_you_mean("horse", {"sheet", "torus"}), "");
}

TEST(Suggestion, HintNamesTheOptionOrCommandThatWasMeant) {
  CLI::App program;
  double radius = 0;
  CLI::App* touch = program.add_subcommand("touch");
  touch->add_option("--radius", radius);
  EXPECT_THROW(program.parse("touch --raduis=3", false), CLI::ParseError);
  EXPECT_EQ(hint(program), "; did you mean --radius?");
  EXPECT_THROW(program.parse("tuoch", false), CLI::ParseError);
  EXPECT_EQ(hint(program), "; did you mean touch?");
  EXPECT_THROW(program.parse("touch --colour red", false), CLI::ParseError);
  EXPECT_EQ(hint(program), "");
}

}  // namespace
}  // namespace palpate::app
