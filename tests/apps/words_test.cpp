#include <gtest/gtest.h>

#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {
namespace {

TEST(Words, NumbersAreGroupedByThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(10653336), "10 653 336");
}

TEST(Words, LengthsHaveThreeDigitsAndAFittingUnit) {
  EXPECT_EQ(length(0.00254), "2.54 mm");
  EXPECT_EQ(length(0.156), "156 mm");
  EXPECT_EQ(length(1.5), "1.50 m");
  EXPECT_EQ(length(3.2e-5), "32.0 um");
  EXPECT_EQ(length(1420), "1420 m");
  EXPECT_EQ(length(14200), "14.2 km");
  EXPECT_EQ(length(0), "0 m");
  EXPECT_EQ(length(0.99999), "1.00 m");
}

TEST(Words, ForeignTextMovesNoTerminal) {
  EXPECT_EQ(without_controls("a\tb\nc\033[31m"), "a?b\nc?[31m");
  EXPECT_EQ(without_controls("\xc2\x9b"
                             "31m\x7f"),
            "?31m?")
      << "one character of two bytes";
  EXPECT_EQ(without_controls("\xd8\x9c \xd8\x9b"), "? \xd8\x9b");
  EXPECT_EQ(without_controls("x\xe2\x80\xae"
                             "gpj.exe\xe2\x81\xa6"),
            "x?gpj.exe?");
  EXPECT_EQ(without_controls("\xc2\xb5m \xe2\x80\xa6 \xe2\x82\xac \xc3\xa9"),
            "\xc2\xb5m \xe2\x80\xa6 \xe2\x82\xac \xc3\xa9");
  EXPECT_EQ(without_controls("cut \xe2\x80"), "cut \xe2\x80");
}

TEST(Words, EnergiesKeepTheirSign) {
  EXPECT_EQ(energy(-0.0123), "-12.3 mJ");
  EXPECT_EQ(energy(2), "2.00 J");
  EXPECT_EQ(energy(1e-9), "0.00 uJ");
}

TEST(Words, NoColourWhereThereIsNoTerminal) {
  std::FILE* file = std::tmpfile();
  const Style style(file);
  EXPECT_EQ(style.heading("a"), "a");
  EXPECT_FALSE(style.colored());
  std::fclose(file);
}

}  // namespace
}  // namespace palpate::app
