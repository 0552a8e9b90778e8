// Times of sequences that are not in seconds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palpate/base/error.hpp"
#include "sensor/folder.hpp"
#include "sensor/sequence.hpp"

namespace palpate {
namespace {

using namespace sensor;
using testing::AllOf;
using testing::HasSubstr;

std::string refusal_of(const Folder& folder) {
  try {
    (void)read_sequence(folder.path());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string with_lens(const std::string& more) {
  return R"({"fx": 4, "fy": 4, "cx": 1.5, "cy": 1, )" + more + "}";
}

TEST(SequenceTimes, HaveToBeSeconds) {
  const Folder folder;
  for (const char* name : {"d/a.pgm", "d/b.pgm"}) folder.write(name, pgm(1));
  folder.write("sequence.json", with_lens(R"("images": "d", "stamps": [1.7e18, 1.70001e18])"));
  EXPECT_THAT(refusal_of(folder), AllOf(HasSubstr("\"stamps\""), HasSubstr("nanoseconds"),
                                        HasSubstr("Divide all times by 1000000000")));
  folder.write("sequence.json", with_lens(R"("frames": "list.txt")"));
  folder.write("list.txt", "# time file\n1700000000000000 d/a.pgm\n1700000000100000 d/b.pgm\n");
  EXPECT_THAT(refusal_of(folder), AllOf(HasSubstr("list.txt, line 2"), HasSubstr("microseconds")));
  folder.write("list.txt", "1700000000.0 d/a.pgm\n1700000000.1 d/b.pgm\n");
  EXPECT_EQ(refusal_of(folder), "no error");
  folder.write("sequence.json", with_lens(R"("frames": "list.txt", "pose": "poses.txt")"));
  folder.write("poses.txt", "1700000000000 0 0 0 0 0 0 1\n");
  EXPECT_THAT(refusal_of(folder), AllOf(HasSubstr("poses.txt, line 1"), HasSubstr("milliseconds"),
                                        HasSubstr("Divide all times by 1000")));
}

}  // namespace
}  // namespace palpate
