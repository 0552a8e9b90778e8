#include "base/shared_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string library_refusal(const std::vector<std::string>& names) {
  try {
    const SharedLibrary library(names, "the maker brings it", SharedLibrary::Unload::never);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(SharedLibrary, IsTheFirstThatLoads) {
  const SharedLibrary library({"libnone.so.3", "libdl.so.2"}, "",
                              SharedLibrary::Unload::with_the_last_copy);
  try {
    (void)library["noSuchFunction"];
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("libdl.so.2"), HasSubstr("noSuchFunction")));
  }
}

TEST(SharedLibrary, TellsOfTheOneThatIsBrokenBeforeThoseThatAreNotThere) {
  EXPECT_THAT(library_refusal({"libnone.so.3", "libnone.so"}),
              AllOf(HasSubstr("libnone.so.3 cannot"), HasSubstr("the maker brings it")));
  const test::Folder folder;
  folder.write("libbroken.so", "no library at all");
  const std::string broken = folder / "libbroken.so";
  for (const auto& names : {std::vector<std::string>{"libnone.so.3", broken, "libnone.so"},
                            std::vector<std::string>{broken, "libnone.so"}}) {
    EXPECT_THAT(library_refusal(names), AllOf(HasSubstr(broken), Not(HasSubstr("libnone"))));
  }
}

}  // namespace
}  // namespace palpate
