#include "apps/palpate/run/opening.hpp"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <string>
#include <variant>

#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

using Kind = Opening::News::Kind;

Opening::Wanted file(const std::string& name, const std::string& bytes) {
  return {name, Opening::Bytes{bytes}};
}

// The news of what has come to its end.
Opening::News end_of(Opening& opening) {
  std::optional<Opening::News> news;
  while (!news || news->kind == Kind::prepares) news = opening.look();
  return *news;
}

TEST(Opening, TellsHowFarItIsAndOnceThatItIsDone) {
  std::promise<void> quarter;
  std::promise<void> go_on;
  std::string taken;
  Opening opening([&](const Opening::Wanted& wanted, const auto& told) {
    told(0.25);
    quarter.set_value();
    go_on.get_future().wait();
    taken = wanted.name + std::get<Opening::Bytes>(wanted.what).bytes;
  });
  EXPECT_FALSE(opening.look());
  opening.begin(file("a.ply", "xyz"));
  quarter.get_future().wait();
  const auto news = opening.look();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->kind, Kind::prepares);
  EXPECT_EQ(news->share, 0.25);
  EXPECT_THROW(opening.begin(file("b.ply", "")), Error);
  go_on.set_value();
  EXPECT_EQ(end_of(opening).kind, Kind::prepared);
  EXPECT_EQ(taken, "a.plyxyz");
  EXPECT_FALSE(opening.look());
  EXPECT_THROW(opening.begin(file("b.ply", "")), Error) << "another run comes";
}

TEST(Opening, WhatIsRefusedMakesRoom) {
  Opening opening([](const Opening::Wanted& wanted, const auto&) {
    if (wanted.name == "bad.ply") throw std::runtime_error("no cloud");
  });
  opening.begin(file("bad.ply", ""));
  const Opening::News news = end_of(opening);
  EXPECT_EQ(news.kind, Kind::refused);
  EXPECT_EQ(news.problem, "no cloud");
  opening.begin(file("good.ply", ""));
  EXPECT_EQ(end_of(opening).kind, Kind::prepared);
}

TEST(Opening, WhatNobodyWaitsForIsReadNoFurther) {
  std::promise<void> begun;
  bool given_up = false;
  {
    Opening opening([&](const Opening::Wanted&, const auto& told) {
      begun.set_value();
      try {
        while (true) told(0.5);
      } catch (const Error&) {
        given_up = true;
        throw;
      }
    });
    opening.begin(file("endless.ply", ""));
    begun.get_future().wait();
  }
  EXPECT_TRUE(given_up);
}

}  // namespace
}  // namespace palpate::app
