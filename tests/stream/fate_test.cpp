// The rows of the table of docs/method.md 7.3.
#include "stream/fate.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr float kShownRadius = 0.01f;

FateFacts facts_at(float beyond) {
  return {.shown = true, .beyond = beyond, .radius = kShownRadius, .may_hide = true};
}

FateFacts with_kind(EntryKind kind, FateFacts facts = {}) {
  facts.kind = kind;
  return facts;
}

TEST(Fate, WhatIsSeenAgainFollows) {
  for (const auto kind : {EntryKind::live, EntryKind::hidden, EntryKind::going}) {
    EXPECT_EQ(fate(with_kind(kind, {.shown = true, .same = true})), Fate::update);
  }
}

TEST(Fate, WhatIsSeenElsewhereByNoNeighbourStays) {
  EXPECT_EQ(fate({.shown = true, .same = true, .vouched = false}), Fate::confirm);
}

TEST(Fate, WhatIsBehindSomethingNearerIsHidden) {
  EXPECT_EQ(fate(facts_at(0.1f)), Fate::hide);
  EXPECT_EQ(fate(with_kind(EntryKind::hidden, facts_at(0.1f))), Fate::hide);
}

TEST(Fate, ABlockRemembersOneHiddenSurface) {
  FateFacts facts = facts_at(0.1f);
  facts.may_hide = false;
  EXPECT_EQ(fate(facts), Fate::go);
}

TEST(Fate, WhatIsBeforeSomethingFartherIsGone) {
  for (const auto kind : {EntryKind::live, EntryKind::hidden, EntryKind::going}) {
    EXPECT_EQ(fate(with_kind(kind, facts_at(-0.1f))), Fate::go);
  }
}

TEST(Fate, WhatGoesDoesNotHide) {
  EXPECT_EQ(fate(with_kind(EntryKind::going, facts_at(0.1f))), Fate::go);
}

TEST(Fate, ASecondPointOfOneSurfaceLeaves) {
  for (const float beyond : {-kShownRadius, 0.0f, kShownRadius})
    EXPECT_EQ(fate(facts_at(beyond)), Fate::remove);
  EXPECT_EQ(fate({.second = true}), Fate::remove);
}

TEST(Fate, WhatNothingIsMeasuredOfIsHeld) {
  for (const auto kind : {EntryKind::live, EntryKind::hidden, EntryKind::out_of_range}) {
    EXPECT_EQ(fate(with_kind(kind)), Fate::retain);
  }
  EXPECT_EQ(fate(with_kind(EntryKind::going)), Fate::go);
}

TEST(Fate, WhatLeftTheImageIsHeldWhateverTheBlockShows) {
  for (const float beyond : {-0.1f, 0.0f, 0.1f}) {
    EXPECT_EQ(fate(with_kind(EntryKind::out_of_range, facts_at(beyond))), Fate::retain);
  }
}

// A plane that is hidden by about R is supposed to go on in some frames and not in others.
TEST(Fate, WhatNobodySawIsHeldBehindWhatIsSeen) {
  const EntryKind kind = EntryKind::supposed;
  for (const float beyond : {0.6f * kShownRadius, kShownRadius, 0.1f}) {
    EXPECT_EQ(fate(with_kind(kind, facts_at(beyond))), Fate::retain);
  }
  EXPECT_EQ(fate(with_kind(kind, facts_at(0.4f * kShownRadius))), Fate::remove);
  EXPECT_EQ(fate(with_kind(kind, facts_at(-0.1f))), Fate::go);
  EXPECT_EQ(fate(with_kind(kind)), Fate::retain);
  EXPECT_EQ(fate(with_kind(kind, {.shown = true, .same = true})), Fate::update);
}

TEST(Fate, WhatLeavesIsGoneForGood) {
  EXPECT_EQ(fate(with_kind(EntryKind::removed)), Fate::remove);
  for (const float beyond : {-0.1f, 0.0f, 0.1f}) {
    EXPECT_EQ(fate(with_kind(EntryKind::removed, facts_at(beyond))), Fate::remove);
  }
}

}  // namespace
}  // namespace palpate
