// Times that are not in seconds, told by their size.
#include "io/time_unit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "palpate/base/error.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(TimeUnit, IsToldByTheSizeOfATime) {
  EXPECT_EQ(io::unit_of_time(1'700'000'000'123'456'789.0).name, "nanoseconds");
  EXPECT_EQ(io::unit_of_time(1'700'000'000'123'456.0).name, "microseconds");
  EXPECT_EQ(io::unit_of_time(1'700'000'000'123.0).per_second, 1e3);
  for (const double seconds : {-5.0, 0.0, 1.9, 1'700'000'000.5, 1e10, 1e300}) {
    EXPECT_FALSE(io::not_in_seconds(seconds)) << seconds;
  }
}

TEST(TimeUnit, OfAHandsPathHasToBeSeconds) {
  const std::string header = "t,hip_x,hip_y,hip_z\n";
  for (const auto& [time, told, factor] :
       {std::tuple("1700000000000000000", "nanoseconds", "by 1000000000."),
        std::tuple("1700000000000000", "microseconds", "by 1000000."),
        std::tuple("1700000000000", "milliseconds", "by 1000.")}) {
    std::istringstream stream(header + time + ",0,0,0\n");
    try {
      (void)read_trajectory(stream, "path.csv");
      FAIL() << time;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("path.csv, line 2"), HasSubstr(time),
                                      HasSubstr(told), HasSubstr(factor)));
    }
  }
  std::istringstream seconds(header + "1700000000.5,0,0,0\n");
  EXPECT_EQ(read_trajectory(seconds, "path.csv").size(), 1U);
}

}  // namespace
}  // namespace palpate
