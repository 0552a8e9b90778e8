// Checks that recycled objects come back and keep their memory.
#include "scene/recycler.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <thread>
#include <vector>

namespace palpate {
namespace {

TEST(Recycler, GivesOutAgainWhatCameBack) {
  Recycler<std::vector<int>> recycler;
  auto first = recycler.take();
  first->assign(1000, 7);
  const std::vector<int>* const object = first.get();
  auto second = recycler.take();
  EXPECT_NE(second.get(), object);
  first.reset();
  const auto again = recycler.take();
  EXPECT_EQ(again.get(), object);
  EXPECT_EQ(again->size(), 1000u) << "with what it held";
}

struct Clear {
  void operator()(std::vector<int>& values) const noexcept { values.clear(); }
};

TEST(Recycler, RestsAsItIsTold) {
  Recycler<std::vector<int>, Clear> recycler;
  recycler.take()->assign(1000, 7);
  const auto again = recycler.take();
  EXPECT_TRUE(again->empty());
  EXPECT_GE(again->capacity(), 1000u);
}

TEST(Recycler, OwnersMayOutliveIt) {
  std::shared_ptr<std::vector<int>> owned;
  {
    Recycler<std::vector<int>> recycler;
    owned = recycler.take();
    owned->assign(10, 3);
  }
  EXPECT_EQ(owned->back(), 3);
  owned.reset();
}

TEST(Recycler, ObjectsComeBackOnAnyThread) {
  Recycler<std::vector<int>> recycler;
  std::set<const std::vector<int>*> objects;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::shared_ptr<std::vector<int>>> owned;
    for (int i = 0; i < 4; ++i) {
      owned.push_back(recycler.take());
      owned.back()->assign(16, round);
      objects.insert(owned.back().get());
    }
    const std::jthread other([mine = std::move(owned)]() mutable { mine.clear(); });
    objects.insert(recycler.take().get());  // while the others come back
  }
  EXPECT_LE(objects.size(), 5u) << "no more than were in use at a time";
}

}  // namespace
}  // namespace palpate
