#include "apps/palpate/run/opening.hpp"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

using Kind = Opening::News::Kind;

// The news of what has come to its end.
Opening::News end_of(Opening& opening, double now) {
  std::optional<Opening::News> news;
  while (!news || news->kind == Kind::prepares) news = opening.look(now);
  return *news;
}

TEST(Opening, TellsNowAndThenThatItGoesOnAndOnceThatItIsDone) {
  std::promise<void> go_on;
  std::string taken;
  Opening opening([&](const std::string& name, const std::string& bytes) {
    go_on.get_future().wait();
    taken = name + bytes;
  });
  EXPECT_FALSE(opening.look(0));
  opening.begin("a.ply", "xyz");
  EXPECT_FALSE(opening.look(10));
  EXPECT_FALSE(opening.look(14.9));
  const auto news = opening.look(15.1);
  ASSERT_TRUE(news);
  EXPECT_EQ(news->kind, Kind::prepares);
  EXPECT_NEAR(news->seconds, 5.1, 1e-9);
  EXPECT_FALSE(opening.look(15.2));
  EXPECT_THROW(opening.begin("b.ply", ""), Error);
  go_on.set_value();
  EXPECT_EQ(end_of(opening, 16).kind, Kind::prepared);
  EXPECT_EQ(taken, "a.plyxyz");
  EXPECT_FALSE(opening.look(30));
  EXPECT_THROW(opening.begin("b.ply", ""), Error) << "another run comes";
}

TEST(Opening, WhatIsRefusedMakesRoom) {
  Opening opening([](const std::string& name, const std::string&) {
    if (name == "bad.ply") throw std::runtime_error("no cloud");
  });
  opening.begin("bad.ply", "");
  const Opening::News news = end_of(opening, 0);
  EXPECT_EQ(news.kind, Kind::refused);
  EXPECT_EQ(news.problem, "no cloud");
  opening.begin("good.ply", "");
  EXPECT_EQ(end_of(opening, 1).kind, Kind::prepared);
}

}  // namespace
}  // namespace palpate::app
