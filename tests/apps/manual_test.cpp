#include <gtest/gtest.h>

#include <regex>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

// What bash offers after `words`, of which the last has only begun.
std::string offered(const std::string& words) {
  Shell shell;
  shell.write("completion", shell.run("--print-completion").out);
  shell.write("ask.sh", "source ./completion\nCOMP_WORDS=(" + words +
                            ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_palpate\n"
                            "echo \"${COMPREPLY[*]}\"\n");
  return shell.run("", "", "bash ask.sh").out;
}

// Every option and command of all the help that there is.
std::vector<std::string> names_in_help(Shell& shell) {
  std::vector<std::string> names;
  for (const char* command : {"touch", "align", "info", "cameras", "doctor", "devices", "demo"}) {
    const std::string help = shell.run(std::string(command) + " --help").out;
    const std::regex name("\n +(?:-h,)?(--[a-z-]+)");
    for (auto each = std::sregex_iterator(help.begin(), help.end(), name);
         each != std::sregex_iterator(); ++each) {
      names.push_back((*each)[1]);
    }
  }
  return names;
}

TEST(Manual, HasEveryOptionOfTheHelp) {
  Shell shell;
  std::string page = shell.run("--print-manual").out;
  page = std::regex_replace(page, std::regex("\\\\-"), "-");
  const std::vector<std::string> names = names_in_help(shell);
  ASSERT_GT(names.size(), 60u);
  for (const std::string& name : names) {
    EXPECT_NE(page.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(page.find("print-manual"), std::string::npos) << "it is hidden";
}

TEST(Completion, OffersCommandsOptionsAndNames) {
  EXPECT_EQ(offered("palpate to"), "touch\n");
  EXPECT_EQ(offered("palpate touch --tool-r"), "--tool-radius\n");
  EXPECT_EQ(offered("palpate touch --field ''"), "balanced pointset metaball\n");
  EXPECT_EQ(offered("palpate demo --camera-x"), "\n");
  EXPECT_EQ(offered("palpate paper fi"), "fig5 fig7\n");
}

}  // namespace
}  // namespace palpate::app
